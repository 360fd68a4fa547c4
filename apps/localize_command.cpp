#include <fmt/format.h>

#include <filesystem>

#include "apps/commands.hpp"
#include "apps/log_run.hpp"
#include "evaluation/report/report.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/pipeline/localizer.hpp"
#include "holdfast/pipeline/map_view.hpp"
#include "holdfast/pipeline/run_files.hpp"

namespace holdfast::apps {
namespace {

struct Arguments {
  std::string log, map, out, initial_pose, method, truth, events;
  bool no_report = false;
  RunOptions run;
};

pipeline::Config load_config(const Arguments& args) {
  pipeline::Config config = value_or_fail(args.run.load(args.log));
  if (!args.method.empty()) {
    auto fields = pipeline::fields_of(config);
    value_or_fail(io::set_field("method=" + args.method, fields), 2);
  }
  return config;
}

void print_result(const pipeline::RunSummary& summary, const Arguments& args) {
  const auto share = [&](State state) {
    return 100.0 * static_cast<double>(summary.scans_in(state)) /
           static_cast<double>(std::max<std::size_t>(summary.scans(), 1));
  };
  fmt::print("{} scans in {:.1f} s, {:.1f} % tracked, {} with a pose; {:.2f} ms a scan (median)\n",
             summary.scans(), summary.seconds(), share(State::kTracking) + share(State::kDegraded),
             summary.claimed(), summary.median_step_ms());
  if (summary.claimed() == 0) {
    fmt::print("no pose was found: {}/events.jsonl tells of each search and its candidates\n",
               args.out);
  }
  fmt::print("run written to {}{}\n", args.out,
             args.no_report ? "" : fmt::format("; look at {}/report.html", args.out));
}

void write_report(const Arguments& args, const std::filesystem::path& run_dir) {
  if (args.no_report) return;
  evaluation::ReportOptions options;
  options.title = std::filesystem::path(args.out).filename().string();
  options.truth = args.truth;
  options.events = args.events;
  value_or_fail(evaluation::write_report(run_dir, options));
}

void localize(const Arguments& args) {
  const pipeline::Config config = load_config(args);
  std::optional<SE3> pose;
  if (!args.initial_pose.empty()) pose = value_or_fail(parse_pose(args.initial_pose), 2);
  LogRun run(args.log, args.run, "localizing");
  auto map = value_or_fail(map::PriorMap::open(args.map));
  const map::MapInfo info = map.info();
  auto localizer =
      value_or_fail(pipeline::Localizer::create(config, std::move(map), pose, args.run.threads));
  auto files = value_or_fail(pipeline::RunFiles::create(args.out));
  run.play(localizer, [&](const StepReport& report, double progress) {
    run.add(report, progress);
    return files.add(report);
  });
  auto about = run.about(config.method);
  about.map = std::filesystem::path(args.map).filename().string();
  about.map_identity = info.identity;
  value_or_fail(files.close());
  value_or_fail(
      files.write("map_view.json", value_or_fail(pipeline::map_view_json(args.map, info))));
  run.write(config, about, files);
  write_report(args, files.staging());
  value_or_fail(files.commit());
  print_result(run.summary(), args);
}

}  // namespace

void add_localize_command(CLI::App& app) {
  auto* command = app.add_subcommand("localize", "localize a log in a prior map");
  auto args = std::make_shared<Arguments>();
  command->add_option("log", args->log, "log: a ROS 1 bag or a KITTI raw folder")->required();
  command->add_option("--map", args->map, "folder of the map (see holdfast map import)")
      ->required();
  command->add_option("--out", args->out, "folder for trajectory, steps, summary, report")
      ->required();
  command->add_option("--initial-pose", args->initial_pose,
                      "\"x y z qx qy qz qw\": T_map_body at the end of the first scan, good to 1 m "
                      "and 10 degrees; without it the map is searched for the pose");
  command->add_option("--method", args->method, "localizer: graph or map_filter");
  command->add_option("--truth", args->truth, "true trajectory (TUM): the report shows errors");
  command->add_option("--events", args->events,
                      "events.jsonl of a simulation: shown in the report");
  command->add_flag("--no-report", args->no_report, "leave report.html out");
  args->run.add_to(*command);
  command->callback([args] { localize(*args); });
}

}  // namespace holdfast::apps
