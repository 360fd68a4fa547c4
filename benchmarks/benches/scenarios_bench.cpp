#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/drive_cases.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/result_log.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::string_view kForTests = "box";

/// The drives of a scenario and a seed have their world and its survey in common.
struct Place {
  std::string scenario;
  std::uint64_t seed = 0;
};

std::string key_of(const Place& place, const DriveCase& what) {
  return fmt::format("{} {} {}", place.scenario, what.name, place.seed);
}

/// The longest time for which each scan was trusted and wrong.
double longest_misleading_s(const evaluation::Evaluation& e) {
  const evaluation::PoseTolerance tolerance = evaluation::EvaluationOptions{}.misleading;
  TimeNs longest = 0, since = 0;
  bool before = false;
  for (const evaluation::ScanRecord& scan : e.series) {
    const bool now = evaluation::is_misleading(scan, tolerance);
    if (now && !before) since = scan.t;
    if (before) longest = std::max(longest, scan.t - since);  // up to the first that is not
    before = now;
  }
  return to_seconds(longest);
}

/// Where nothing was claimed, errors are null: not known, and no better than infinite.
Json json_of(const evaluation::Evaluation& e) {
  Json j;
  j["ate_rmse_m"] = known(e.claimed > 0 ? e.trans_m.rmse : kInfinite);
  j["max_m"] = known(e.claimed > 0 ? e.trans_m.max : kInfinite);
  j["coverage"] = known(e.coverage.value());
  j["success"] = known(e.success.value());
  j["trusted"] = known(e.trusted.value());
  j["misleading"] = known(e.misleading.value());
  j["longest_misleading_s"] = longest_misleading_s(e);
  j["scans"] = e.scans;
  return j;
}

/// The drives of one place, of those cases that the log does not know.
class PlaceRun {
 public:
  PlaceRun(const Place& place, const BenchOptions& options, const ScratchFolder& scratch)
      : scratch_(scratch),
        spec_{place.scenario, place.seed, options.duration_s, 1, options.settings} {}

  Result<Json> drive(const DriveCase& what) {
    if (surveyed_.simulation == nullptr) {
      auto surveyed = survey_drive(spec_, scratch_.path());
      if (!surveyed) return surveyed.error();
      surveyed_ = std::move(*surveyed);
    }
    DriveSpec spec = spec_;
    spec.events = what.events;
    spec.changed_share = what.changed_share;
    spec.motion = what.motion;
    auto drive = make_drive(spec);
    if (!drive) return drive.error();
    const auto steps =
        localize(**drive, surveyed_.config, surveyed_.map_dir, (*drive)->initial_pose());
    if (!steps) return steps.error();
    const auto judged = judge(*steps, (*drive)->truth());
    if (!judged) return judged.error();
    return json_of(*judged);
  }

 private:
  const ScratchFolder& scratch_;
  DriveSpec spec_;
  SurveyedDrive surveyed_;
};

/// All results, in the file if there is one.
class Results {
 public:
  Results(ResultLog log, std::size_t all, const Progress& progress)
      : log_(std::move(log)), all_(all), progress_(progress) {}

  bool has(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    return log_.find(key).has_value();
  }

  Json of(const std::string& key) const { return log_.find(key).value_or(Json::object()); }

  /// A drive that could not be made is a result, too; one that cannot be written ends the bench.
  void add(const std::string& key, const Result<Json>& result) {
    const std::lock_guard lock(mutex_);
    const Status added =
        log_.add(key, result ? *result : Json{{"failure", result.error().message}});
    if (!added && status_) status_ = added;
  }

  void count(const std::string& what) {
    const std::lock_guard lock(mutex_);
    progress_(static_cast<double>(++done_) / static_cast<double>(all_), what);
  }

  const Status& status() const { return status_; }

 private:
  ResultLog log_;
  std::size_t all_, done_ = 0;
  const Progress& progress_;
  Status status_ = Done{};
  mutable std::mutex mutex_;
};

void drive_all(const Place& place, const std::vector<DriveCase>& cases, const BenchOptions& options,
               Results& results) {
  auto scratch = ScratchFolder::create();
  if (!scratch) {
    for (const DriveCase& what : cases) results.add(key_of(place, what), scratch.error());
    return;
  }
  PlaceRun run(place, options, *scratch);
  for (const DriveCase& what : cases) {
    const std::string key = key_of(place, what);
    if (!results.has(key)) results.add(key, run.drive(what));
    results.count(key);
  }
}

double number(const Json& drive, const char* name, double if_none) {
  return drive.contains(name) && drive[name].is_number() ? drive[name].get<double>() : if_none;
}

std::vector<double> all_of(const std::vector<Json>& drives, const char* name, double if_none) {
  std::vector<double> values;
  for (const Json& drive : drives) values.push_back(number(drive, name, if_none));
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// One line of the table, and the same for machines.
Json summarise(const std::string& scenario, const DriveCase& what, const std::vector<Json>& drives,
               Table& table) {
  using namespace evaluation;
  const auto rmse_m = all_of(drives, "ate_rmse_m", kInfinite);
  const double worst_m = largest(all_of(drives, "max_m", kInfinite));
  const double success = mean(all_of(drives, "success", 0));
  const double coverage = smallest(all_of(drives, "coverage", 0));
  const double trusted = smallest(all_of(drives, "trusted", 0));
  const double misleading = mean(all_of(drives, "misleading", 0));
  const double spell_s = largest(all_of(drives, "longest_misleading_s", 0));
  const auto failed = std::count_if(rmse_m.begin(), rmse_m.end(),
                                    [](double value) { return !std::isfinite(value); });
  table.add_row({fmt::format("{}, {}", scenario, what.name), length_text(median(rmse_m)),
                 length_text(largest(rmse_m)), length_text(worst_m), share_text(success),
                 share_text(coverage), share_text(trusted), share_text(misleading),
                 spell_s > 0 ? seconds_text(spell_s) : "none",
                 count_text(static_cast<double>(failed))});
  return {{"scenario", scenario},
          {"case", what.name},
          {"ate_rmse_median_m", known(median(rmse_m))},
          {"ate_rmse_worst_m", known(largest(rmse_m))},
          {"max_m", known(worst_m)},
          {"success", known(success)},
          {"coverage_worst", known(coverage)},
          {"trusted_worst", known(trusted)},
          {"misleading", known(misleading)},
          {"longest_misleading_s", known(spell_s)},
          {"failed", failed},
          {"drives", drives}};
}

Result<std::vector<std::string>> names_of(const BenchOptions& options) {
  std::vector<std::string> names;
  for (const simulation::ScenarioInfo& info : simulation::scenarios()) {
    if (options.scenarios.empty() && info.name != kForTests) names.emplace_back(info.name);
  }
  for (const std::string& name : options.scenarios) {
    if (auto made = simulation::make_scenario(name); !made) return made.error();
    names.push_back(name);
  }
  return names;
}

Result<ResultLog> open_log(const BenchOptions& options) {
  if (options.out.empty()) return ResultLog();
  return ResultLog::open(options.out / "scenarios.drives.jsonl",
                         {{"duration_s", options.duration_s}, {"settings", options.settings}});
}

}  // namespace

Result<BenchReport> measure_scenarios(const BenchOptions& options) {
  const auto names = names_of(options);
  if (!names) return names.error();
  auto log = open_log(options);
  if (!log) return log.error();
  const std::vector<DriveCase> cases = drive_cases(options.duration_s);
  std::vector<Place> places;
  for (const std::string& name : *names) {
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      places.push_back({name, seed});
    }
  }
  Results results(std::move(*log), places.size() * cases.size(), options.progress);
  WorkerPool(options.threads).run(places.size(), [&](std::size_t i) {
    drive_all(places[i], cases, options, results);
  });
  if (!results.status()) return results.status().error();

  BenchReport report;
  Table table({"scenario, case", "ATE RMSE, median", "worst", "largest error", "success",
               "coverage, worst", "trusted, worst", "misleading", "longest spell", "failed"});
  for (const std::string& name : *names) {
    for (const DriveCase& what : cases) {
      std::vector<Json> drives;
      for (const Place& place : places) {
        if (place.scenario == name) drives.push_back(results.of(key_of(place, what)));
      }
      report.data["results"].push_back(summarise(name, what, drives, table));
    }
  }
  report.markdown = table.markdown();
  report.markdown += fmt::format(
      "\n{} drives of each. Events begin after two fifths of a drive and last a tenth of it, if "
      "they last; in changed worlds a fifth of the objects has moved since the survey. Misleading: "
      "share of the scans that are trusted and wrong, and the longest time on end; failed: drives "
      "without any claim.\n",
      options.seeds.count());
  return report;
}

}  // namespace holdfast::benchmarks
