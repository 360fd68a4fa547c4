#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "apps/commands.hpp"
#include "apps/log_account.hpp"
#include "apps/progress_bar.hpp"
#include "apps/run_options.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"
#include "holdfast/pipeline/run_summary.hpp"

namespace holdfast::apps {
namespace {

struct Arguments {
  std::string log, out;
  RunOptions run;
};

/// A run while it goes on.
struct Run {
  pipeline::OdometryFiles files;
  pipeline::RunSummary summary;
  ProgressBar bar{"odometry"};
  int breaks = 0;

  Status on_scan(const odometry::OdometryReport& report, double progress) {
    summary.add(report.step);
    breaks += report.broke ? 1 : 0;
    bar.update(progress, fmt::format("{} scans, {}, {:.2f} ms a scan", summary.scans(),
                                     to_string(report.step.state), report.step.times.total_ms));
    return files.add(report);
  }
};

pipeline::RunSummary::About about_run(const Arguments& args, const io::LogReader& reader,
                                      int breaks, double elapsed_s) {
  pipeline::RunSummary::About about;
  about.method = "odometry";
  about.log = std::filesystem::path(args.log).filename().string();
  about.threads = args.run.threads;
  about.elapsed_s = elapsed_s;
  about.counters = counters_of(reader);
  about.counters.emplace_back("odom_breaks", breaks);
  about.warnings = warnings_of(reader);
  return about;
}

void run_odometry(const Arguments& args) {
  pipeline::Config config = value_or_fail(args.run.load(args.log));
  const auto log_options = value_or_fail(args.run.log_options(), 2);
  auto reader = value_or_fail(io::open_log(args.log, log_options));
  odometry::Odometry odometry(pipeline::odometry_setup(config, args.run.threads));
  Run run{value_or_fail(pipeline::OdometryFiles::create(args.out)), {}};
  const auto begin = std::chrono::steady_clock::now();
  value_or_fail(pipeline::run(*reader, odometry, [&](const auto& report, double progress) {
    return run.on_scan(report, progress);
  }));
  if (run.summary.scans() == 0) {
    throw CommandFailed{
        1, fmt::format("{}: no scan in this log{}", args.log,
                       args.run.scans.empty() ? "" : " with --scans " + args.run.scans)};
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  value_or_fail(run.files.close());
  value_or_fail(run.files.write("config.yaml", io::write_config(pipeline::fields_of(config))));
  value_or_fail(run.files.write(
      "summary.json", run.summary.json(about_run(args, *reader, run.breaks, elapsed.count()))));
  value_or_fail(run.files.commit());
  fmt::print("{} scans in {:.1f} s, {} breaks; {:.2f} ms a scan (median)\nrun written to {}\n",
             run.summary.scans(), run.summary.seconds(), run.breaks, run.summary.median_step_ms(),
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
