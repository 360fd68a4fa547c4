#include <fmt/format.h>

#include <array>
#include <limits>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/drive_series.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor", "office", "hall", "warehouse", "yard"};

/// One drive. Where nothing was claimed the errors are infinite: a failure is never left out.
struct DriveResult : SeriesDrive {
  double rmse_m = std::numeric_limits<double>::infinity();
  double max_m = std::numeric_limits<double>::infinity();
  double coverage = 0, success = 0, trusted = 0;
  std::size_t scans = 0, misleading = 0;
  double path_m = 0;
  double step_p50_ms = evaluation::kNotKnown;
};

/// Sensor events from the simulator go to the localizer as they come: no log on disk.
Status drive_and_judge(const DriveSpec& spec, DriveResult& result) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto drive = survey_drive(spec, scratch->path());
  if (!drive) return drive.error();
  const auto steps =
      localize(*drive->simulation, drive->config, drive->map_dir, drive->initial_pose);
  if (!steps) return steps.error();
  const auto e = judge(*steps, drive->simulation->truth());
  if (!e) return e.error();
  if (e->claimed > 0) {
    result.rmse_m = e->trans_m.rmse;
    result.max_m = e->trans_m.max;
  }
  result.coverage = e->coverage.value();
  result.success = e->success.value();
  result.trusted = e->trusted.value();
  result.misleading = e->misleading.count;
  result.scans = e->scans;
  result.path_m = e->path_m;
  std::vector<double> step_ms;
  for (const StepReport& step : *steps) step_ms.push_back(step.times.total_ms);
  result.step_p50_ms = evaluation::median(std::move(step_ms));
  return Done{};
}

nlohmann::ordered_json json_of(const DriveResult& d) {
  nlohmann::ordered_json j;
  j["seed"] = d.seed;
  j["ate_rmse_m"] = known(d.rmse_m);
  j["max_m"] = known(d.max_m);
  j["coverage"] = known(d.coverage);
  j["success"] = known(d.success);
  j["trusted"] = known(d.trusted);
  j["misleading"] = d.misleading;
  j["scans"] = d.scans;
  j["path_m"] = known(d.path_m);
  j["step_p50_ms"] = known(d.step_p50_ms);
  if (!d.failure.empty()) j["failure"] = d.failure;
  return j;
}

/// The drives of one scenario in one figure each: medians, and the worst.
struct Summary {
  std::vector<double> rmse_m, max_m, coverage, trusted, step_p50_ms;
  std::size_t misleading = 0, failed = 0;

  void add(const DriveResult& d) {
    rmse_m.push_back(d.rmse_m);
    max_m.push_back(d.max_m);
    coverage.push_back(d.coverage);
    trusted.push_back(d.trusted);
    if (std::isfinite(d.step_p50_ms)) step_p50_ms.push_back(d.step_p50_ms);
    misleading += d.misleading;
    failed += std::isfinite(d.rmse_m) ? 0 : 1;
  }
};

nlohmann::ordered_json json_of(const Summary& s) {
  nlohmann::ordered_json j;
  j["ate_rmse_median_m"] = known(evaluation::median(s.rmse_m));
  j["ate_rmse_worst_m"] = known(largest(s.rmse_m));
  j["max_m"] = known(largest(s.max_m));
  j["coverage_worst"] = known(smallest(s.coverage));
  j["trusted_worst"] = known(smallest(s.trusted));
  j["misleading"] = s.misleading;
  j["failed"] = s.failed;
  j["step_p50_median_ms"] = known(evaluation::median(s.step_p50_ms));
  return j;
}

void add_row(const char* scenario, const Summary& s, Table& table) {
  using namespace evaluation;
  table.add_row({scenario, count_text(static_cast<double>(s.rmse_m.size())),
                 length_text(median(s.rmse_m)), length_text(largest(s.rmse_m)),
                 length_text(largest(s.max_m)), share_text(smallest(s.coverage)),
                 share_text(smallest(s.trusted)), count_text(static_cast<double>(s.misleading)),
                 count_text(static_cast<double>(s.failed)),
                 milliseconds_text(median(s.step_p50_ms))});
}

}  // namespace

Result<BenchReport> measure_accuracy(const BenchOptions& options) {
  const auto series = measure_series<DriveResult>(kScenarios, options, drive_and_judge);
  BenchReport report;
  Table table({"scenario", "drives", "ATE RMSE, median", "ATE RMSE, worst", "largest error",
               "coverage, worst", "trusted, worst", "misleading scans", "failed drives",
               "step p50"});
  for (const auto& [scenario, drives] : series) {
    Summary summary;
    nlohmann::ordered_json runs;
    for (const DriveResult& drive : drives) {
      summary.add(drive);
      runs.push_back(json_of(drive));
    }
    nlohmann::ordered_json j = {{"scenario", scenario}};
    j.update(json_of(summary));
    j["drives"] = runs;
    report.data["results"].push_back(j);
    add_row(scenario, summary, table);
  }
  report.markdown = table.markdown();
  report.markdown +=
      "\nWithout alignment; each drive in a survey of its own. Step: thread CPU time.\n";
  return report;
}

}  // namespace holdfast::benchmarks
