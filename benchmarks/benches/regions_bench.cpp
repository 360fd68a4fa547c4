#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "benchmarks/scores/region_scores.hpp"
#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr const char* kScenario = "campus";  // the one with regions

/// How long the way takes with this seed.
Result<double> whole_drive_s(std::uint64_t seed) {
  simulation::SimulationOptions options;
  options.scenario = kScenario;
  options.seed = seed;
  const auto drive = simulation::Simulation::create(options);
  if (!drive) return drive.error();
  return to_seconds((*drive)->end_time() - (*drive)->start_time());
}

Result<std::vector<RegionScore>> drive_through(DriveSpec spec) {
  const auto whole_s = whole_drive_s(spec.seed);
  if (!whole_s) return whole_s.error();
  spec.duration_s = std::min(spec.duration_s, *whole_s);
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto drive = survey_drive(spec, scratch->path());
  if (!drive) return drive.error();
  simulation::Simulation& simulation = *drive->simulation;
  const auto steps = localize(simulation, drive->config, drive->map_dir, drive->initial_pose);
  if (!steps) return steps.error();
  const auto judged = judge(*steps, simulation.truth());
  if (!judged) return judged.error();
  return score_regions(simulation.scenario().regions, judged->series);
}

/// A region over all drives: the worst drive counts.
struct Summary {
  std::string name;
  double path_m = 0;
  std::vector<double> rmse_m, max_m, trusted;
  std::size_t scans = 0, misleading = 0;

  void add(const RegionScore& score) {
    const auto errors = evaluation::error_statistics(score.trans_m);
    const double infinite = std::numeric_limits<double>::infinity();
    name = score.name;
    path_m += score.path_m;
    rmse_m.push_back(score.trans_m.empty() ? infinite : errors.rmse);
    max_m.push_back(score.trans_m.empty() ? infinite : errors.max);
    trusted.push_back(score.trusted.value());
    scans += score.scans;
    misleading += score.misleading.count;
  }
};

nlohmann::ordered_json json_of(const Summary& s) {
  return {{"region", s.name},
          {"path_m", known(s.path_m)},
          {"scans", s.scans},
          {"ate_rmse_median_m", known(evaluation::median(s.rmse_m))},
          {"ate_rmse_worst_m", known(largest(s.rmse_m))},
          {"max_m", known(largest(s.max_m))},
          {"trusted_worst", known(smallest(s.trusted))},
          {"misleading", s.misleading}};
}

void add_row(const Summary& s, Table& table) {
  using namespace evaluation;
  table.add_row({s.name, length_text(s.path_m), count_text(static_cast<double>(s.scans)),
                 length_text(median(s.rmse_m)), length_text(largest(s.rmse_m)),
                 length_text(largest(s.max_m)), share_text(smallest(s.trusted)),
                 count_text(static_cast<double>(s.misleading))});
}

}  // namespace

Result<BenchReport> measure_regions(const BenchOptions& options) {
  std::vector<Summary> regions;
  for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
    options.progress(static_cast<double>(seed - options.seeds.first) /
                         static_cast<double>(options.seeds.count()),
                     fmt::format("{}, seed {}", kScenario, seed));
    const auto scores =
        drive_through({kScenario, seed, options.duration_s, options.threads, options.settings});
    if (!scores) return scores.error();
    regions.resize(scores->size());
    for (std::size_t i = 0; i < regions.size(); ++i) regions[i].add((*scores)[i]);
  }
  BenchReport report;
  Table table({"region", "way", "scans", "ATE RMSE, median", "worst", "largest error",
               "trusted, worst", "misleading scans"});
  for (const Summary& region : regions) {
    if (region.scans == 0) continue;
    report.data["results"].push_back(json_of(region));
    add_row(region, table);
  }
  report.markdown = table.markdown();
  report.markdown += fmt::format(
      "\n{} of the {}, there and back: by the region in which the robot truly was. Without "
      "alignment, in a survey of the drive's own; way and scans are sums over the drives.\n",
      options.seeds.count() == 1 ? "One drive" : fmt::format("{} drives", options.seeds.count()),
      kScenario);
  return report;
}

}  // namespace holdfast::benchmarks
