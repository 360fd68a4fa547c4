#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/log_run.hpp"

namespace holdfast::apps {
namespace {

struct Arguments {
  std::string log, out;
  RunOptions run;
};

void run_odometry(const Arguments& args) {
  const pipeline::Config config = value_or_fail(args.run.load(args.log));
  LogRun run(args.log, args.run, "odometry");
  odometry::Odometry odometry(pipeline::odometry_setup(config, args.run.threads));
  auto files = value_or_fail(pipeline::OdometryFiles::create(args.out));
  int breaks = 0;
  run.play(odometry, [&](const odometry::OdometryReport& report, double progress) {
    run.add(report.step, progress);
    breaks += report.broke ? 1 : 0;
    return files.add(report);
  });
  auto about = run.about("odometry");
  about.counters.emplace_back("odom_breaks", breaks);
  value_or_fail(files.close());
  run.write(config, about, files);
  value_or_fail(files.commit());
  fmt::print("{} scans in {:.1f} s, {} breaks; {:.2f} ms a scan (median)\nrun written to {}\n",
             run.summary().scans(), run.summary().seconds(), breaks, run.summary().median_step_ms(),
             args.out);
}

}  // namespace

void add_odometry_command(CLI::App& app) {
  auto* command = app.add_subcommand("odometry", "LiDAR-inertial odometry of a log, without a map");
  auto args = std::make_shared<Arguments>();
  command->add_option("log", args->log, "log: a ROS 1 bag or a KITTI raw folder")->required();
  command->add_option("--out", args->out, "folder for odometry.tum, steps, events, summary")
      ->required();
  args->run.add_to(*command);
  command->callback([args] { run_odometry(*args); });
}

}  // namespace holdfast::apps
