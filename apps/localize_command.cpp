#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "apps/commands.hpp"
#include "apps/log_account.hpp"
#include "apps/progress_bar.hpp"
#include "apps/run_options.hpp"
#include "evaluation/report/report.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/pipeline/localizer.hpp"
#include "holdfast/pipeline/map_view.hpp"
#include "holdfast/pipeline/run_files.hpp"
#include "holdfast/pipeline/run_summary.hpp"
#include "holdfast/pipeline/runner.hpp"

namespace holdfast::apps {
namespace {

struct Arguments {
  std::string log, map, out, initial_pose, method, truth, events;
  bool no_report = false;
  RunOptions run;
};

/// A run while it goes on.
struct Run {
  pipeline::RunFiles files;
  pipeline::RunSummary summary;
  ProgressBar bar{"localizing"};

  Status on_step(const StepReport& report, double progress) {
    summary.add(report);
    bar.update(progress, fmt::format("{} scans, {}, {:.2f} ms a scan", summary.scans(),
                                     to_string(report.state), report.times.total_ms));
    return files.add(report);
  }
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
  fmt::print("run written to {}{}\n", args.out,
             args.no_report ? "" : fmt::format("; look at {}/report.html", args.out));
}

pipeline::RunSummary::About about_run(const Arguments& args, const pipeline::Config& config,
                                      const map::MapInfo& info, const io::LogReader& reader,
                                      double elapsed_s) {
  pipeline::RunSummary::About about;
  about.method = config.method;
  about.log = std::filesystem::path(args.log).filename().string();
  about.map = std::filesystem::path(args.map).filename().string();
  about.map_identity = info.identity;
  about.threads = args.run.threads;
  about.elapsed_s = elapsed_s;
  about.counters = counters_of(reader);
  about.warnings = warnings_of(reader);
  return about;
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
  const auto log_options = value_or_fail(args.run.log_options(), 2);
  auto reader = value_or_fail(io::open_log(args.log, log_options));
  auto map = value_or_fail(map::PriorMap::open(args.map));
  const map::MapInfo info = map.info();
  auto localizer =
      value_or_fail(pipeline::Localizer::create(config, std::move(map), pose, args.run.threads));
  Run run{value_or_fail(pipeline::RunFiles::create(args.out)), {}};
  const auto begin = std::chrono::steady_clock::now();
  value_or_fail(pipeline::run(*reader, localizer, [&](const StepReport& report, double progress) {
    return run.on_step(report, progress);
  }));
  if (run.summary.scans() == 0) {
    throw CommandFailed{
        1, fmt::format("{}: no scan in this log{}", args.log,
                       args.run.scans.empty() ? "" : " with --scans " + args.run.scans)};
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  value_or_fail(run.files.close());
  pipeline::Config written = config;
  value_or_fail(run.files.write("config.yaml", io::write_config(pipeline::fields_of(written))));
  value_or_fail(
      run.files.write("map_view.json", value_or_fail(pipeline::map_view_json(args.map, info))));
  value_or_fail(run.files.write(
      "summary.json", run.summary.json(about_run(args, config, info, *reader, elapsed.count()))));
  write_report(args, run.files.staging());
  value_or_fail(run.files.commit());
  print_result(run.summary, args);
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
                      "and 10 degrees");
  command->add_option("--method", args->method, "localizer: map_filter");
  command->add_option("--truth", args->truth, "true trajectory (TUM): the report shows errors");
  command->add_option("--events", args->events,
                      "events.jsonl of a simulation: shown in the report");
  command->add_flag("--no-report", args->no_report, "leave report.html out");
  args->run.add_to(*command);
  command->callback([args] { localize(*args); });
}

}  // namespace holdfast::apps
