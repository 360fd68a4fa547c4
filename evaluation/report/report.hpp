#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluate.hpp"
#include "evaluation/files/map_view.hpp"
#include "evaluation/files/run_files.hpp"

namespace holdfast::evaluation {

/// All that a report shows. What is absent leaves its panel out.
struct ReportInput {
  std::string title;              ///< name of the run
  std::vector<ScanRecord> scans;  ///< the evaluation's series, or scans without errors
  StepTable steps;
  Trajectory truth;               ///< empty: unknown
  std::vector<Event> events;      ///< what was done to the robot
  std::vector<Event> run_events;  ///< what the run reported
  std::optional<RunSummary> summary;
  std::optional<MapView> map;
  std::optional<Evaluation> evaluation;
  std::vector<std::string> warnings;  ///< sentences
};

/// The report's data as a JSON object; pure ASCII and without '<', so that it can stand in a page.
/// Deterministic.
std::string report_payload(const ReportInput& input);

/// One HTML page that needs nothing else: it loads no file and no address.
std::string report_html(const ReportInput& input);

struct ReportOptions {
  std::filesystem::path trajectory;  ///< empty: RUN/trajectory.tum, or without it RUN/odometry.tum
  std::filesystem::path truth;       ///< empty: none
  std::filesystem::path events;      ///< empty: none
  EvaluationOptions evaluation;
  std::string title;  ///< empty: the name of the run's folder
};

/// Reads the trajectory and, where present, RUN's steps.csv, events.jsonl (both only beside a run's
/// own trajectory.tum or odometry.tum), summary.json and map_view.json. Writes RUN/report.html,
/// whole or not at all, and returns its path; of another trajectory than the run's own it is
/// RUN/report_NAME.html. Errors: no trajectory, a truth that does not fit (see evaluate), a
/// trajectory, truth, steps or event file that cannot be read. A damaged summary or map view only
/// costs its panel and becomes a warning in the report.
Result<std::filesystem::path> write_report(const std::filesystem::path& run,
                                           const ReportOptions& options = {});

}  // namespace holdfast::evaluation
