#include "evaluation/report/report.hpp"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "evaluation/files/text_file.hpp"
#include "evaluation/report/page_assets.hpp"
#include "evaluation/time_overlap.hpp"
#include "holdfast/io/atomic_output.hpp"

namespace holdfast::evaluation {
namespace {

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

Result<std::filesystem::path> find_trajectory(const std::filesystem::path& run) {
  for (const char* name : {"trajectory.tum", "odometry.tum"})
    if (file_exists(run / name)) return run / name;
  return Error{
      fmt::format("{}: expected a run's folder with a trajectory.tum, found none", run.string())};
}

/// A file that a report can do without: absent, it is left out; damaged, it becomes a warning.
template <class T>
std::optional<T> read_optional(const std::filesystem::path& path,
                               Result<T> (*read)(const std::filesystem::path&),
                               std::vector<std::string>& warnings) {
  if (!file_exists(path)) return std::nullopt;
  Result<T> value = read(path);
  if (value) return std::move(*value);
  warnings.push_back(value.error().message);
  return std::nullopt;
}

bool is_named(const std::filesystem::path& path, const char* name) {
  return path.filename() == name;
}

Status read_events_into(const std::filesystem::path& path, std::vector<Event>& events) {
  Result<EventList> list = read_events(path);
  if (!list) return list.error();
  events = std::move(list->events);
  return Done{};
}

/// Steps and events belong to a run's own files only, as in evaluate_files.
Status read_steps_and_events(const std::filesystem::path& trajectory, ReportInput& input) {
  const std::filesystem::path run = trajectory.parent_path();
  const bool is_odometry = is_named(trajectory, "odometry.tum");
  if (!is_odometry && !is_named(trajectory, "trajectory.tum")) return Done{};
  if (file_exists(run / "steps.csv")) {
    Result<StepTable> steps = read_steps(run / "steps.csv");
    if (!steps) return steps.error();
    input.steps = std::move(*steps);
    if (input.steps.truncated)
      input.warnings.push_back("steps.csv ends in the middle of a line, which was left out");
  }
  if (!file_exists(run / "events.jsonl")) return Done{};
  return read_events_into(run / "events.jsonl", input.run_events);
}

/// Without a truth the estimate itself gives the span of time in which scans were due.
Status list_scans(const std::filesystem::path& trajectory, const Trajectory& estimate,
                  ReportInput& input) {
  const TruthTrack span(estimate);
  const bool is_odometry = trajectory.filename() == "odometry.tum";
  if (estimate.empty() && input.steps.rows.empty())
    return Error{fmt::format("{} holds no pose", trajectory.string())};
  input.scans = input.steps.rows.empty()
                    ? scans_from_period(estimate, span).scans
                    : scans_from_steps(estimate, input.steps.rows, is_odometry, span).scans;
  for (ScanRecord& scan : input.scans) scan.truth = {};
  return Done{};
}

Status judge_run(const std::filesystem::path& trajectory, const ReportOptions& options,
                 ReportInput& input) {
  const EvaluationPaths paths{trajectory, options.truth, options.events};
  Result<Evaluation> evaluation = evaluate_files(paths, options.evaluation);
  if (!evaluation) return evaluation.error();
  Result<Trajectory> truth = read_trajectory(options.truth);
  if (!truth) return truth.error();
  input.truth = std::move(*truth);
  input.scans = evaluation->series;
  input.evaluation = std::move(*evaluation);
  return Done{};
}

std::string folder_name(const std::filesystem::path& folder) {
  const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

Result<ReportInput> gather(const std::filesystem::path& run,
                           const std::filesystem::path& trajectory, const ReportOptions& options) {
  ReportInput input;
  input.title = options.title.empty() ? folder_name(run) : options.title;
  if (const Status read = read_steps_and_events(trajectory, input); !read) return read.error();
  if (!options.events.empty())
    if (const Status read = read_events_into(options.events, input.events); !read)
      return read.error();
  if (options.truth.empty()) {
    const Result<Trajectory> estimate = read_trajectory(trajectory);
    if (!estimate) return estimate.error();
    if (const Status listed = list_scans(trajectory, *estimate, input); !listed)
      return listed.error();
  } else if (const Status judged = judge_run(trajectory, options, input); !judged) {
    return judged.error();
  }
  input.summary = read_optional(run / "summary.json", read_summary, input.warnings);
  input.map = read_optional(run / "map_view.json", read_map_view, input.warnings);
  return input;
}

/// Of the run's own trajectory "report.html", of another one a name that tells.
std::string report_name(const std::filesystem::path& run, const std::filesystem::path& trajectory) {
  const Result<std::filesystem::path> own = find_trajectory(run);
  std::error_code ignored;
  if (!own || std::filesystem::equivalent(*own, trajectory, ignored)) return "report.html";
  return fmt::format("report_{}.html", trajectory.stem().string());
}

}  // namespace

std::string report_html(const ReportInput& input) {
  const auto fill = [&](std::string_view name) -> std::string {
    if (name == "title") return escape_html(input.title);
    if (name == "payload") return report_payload(input);
    return std::string(page_asset(name));
  };
  const std::string_view page = page_asset("template.html");
  std::string html;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    const std::size_t close = page.find("}}", open);
    html += page.substr(at, open - at);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    html += fill(page.substr(open + 2, close - open - 2));
    at = close + 2;
  }
  return html;
}

Result<std::filesystem::path> write_report(const std::filesystem::path& run,
                                           const ReportOptions& options) {
  const Result<std::filesystem::path> trajectory =
      options.trajectory.empty() ? find_trajectory(run)
                                 : Result<std::filesystem::path>(options.trajectory);
  if (!trajectory) return trajectory.error();
  const Result<ReportInput> input = gather(run, *trajectory, options);
  if (!input) return input.error();
  const std::filesystem::path path = run / report_name(run, *trajectory);
  if (const Status written = io::write_file_atomically(path, report_html(*input)); !written)
    return written.error();
  return path;
}

}  // namespace holdfast::evaluation
