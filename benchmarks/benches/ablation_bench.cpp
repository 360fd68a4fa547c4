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
#include "holdfast/pipeline/methods/odometry_run.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor", "office", "hall"};
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A row of the table: the system with other settings, or the odometry alone.
struct Variant {
  const char* key;
  const char* name;
  std::vector<std::string> settings;
  bool without_map = false;
  double article_rmse_m = kNone;  ///< Table 7: on the article's own recording, another drive
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> kVariants = {
      {"full", "full: graph of IMU, map and odometry", {"method=graph"}, false, 0.062},
      {"without_odometry",
       "without odometry",
       {"method=graph", "graph.odometry=off"},
       false,
       0.089},
      {"without_prior_map", "without prior map: odometry alone", {}, true, 0.158},
      {"map_filter", "map_filter", {"method=map_filter"}},
      {"log_features", "on features: log", {"method=map_filter", "features=log"}},
      {"fitted_features", "on features: fitted", {"method=map_filter", "features=fitted"}},
      {"fit_at_query",
       "on features: log, fit_at_query",
       {"method=map_filter", "features=log", "fit_at_query=true"}},
      {"fit_planes_at_query",
       "on features: log, fit_at_query, planes only",
       {"method=map_filter", "features=log", "fit_at_query=true", "query_matching.edge_weight=0"}},
  };
  return kVariants;
}

/// One variant on one drive. Where nothing was claimed the errors are infinite.
struct VariantRun {
  double rmse_m = std::numeric_limits<double>::infinity();
  double max_m = std::numeric_limits<double>::infinity();
  double coverage = 0;
};

struct AblationDrive : SeriesDrive {
  std::vector<VariantRun> runs = std::vector<VariantRun>(variants().size());
};

/// The odometry alone, which is told where it begins and nothing after that: in the map by the true
/// pose of its first scan.
Result<std::vector<StepReport>> follow(simulation::Simulation& log,
                                       const pipeline::Config& config) {
  odometry::Odometry odometry(pipeline::odometry_setup(config));
  std::vector<StepReport> steps;
  SE3 T_map_odom;
  const auto keep = [&](const odometry::OdometryReport& report, double) -> Status {
    StepReport step = report.step;
    if (steps.empty()) T_map_odom = log.truth_at(step.pose_time) * step.T_map_body.inverse();
    step.T_map_body = T_map_odom * step.T_map_body;
    steps.push_back(step);
    return Done{};
  };
  if (auto done = pipeline::run(log, odometry, keep); !done) return done.error();
  return steps;
}

Status run_variant(const Variant& variant, const DriveSpec& spec, const SurveyedDrive& drive,
                   VariantRun& run) {
  const auto log = make_drive(spec);
  if (!log) return log.error();
  pipeline::Config config = drive.config;
  auto fields = pipeline::fields_of(config);
  for (const std::string& setting : variant.settings) {
    if (auto set = io::set_field(setting, fields); !set) return set;
  }
  const auto steps = variant.without_map
                         ? follow(**log, config)
                         : localize(**log, config, drive.map_dir, drive.initial_pose);
  if (!steps) return steps.error();
  const auto e = judge(*steps, drive.simulation->truth());
  if (!e) return e.error();
  run.coverage = e->coverage.value();
  if (e->claimed == 0) return Done{};
  run.rmse_m = e->trans_m.rmse;
  run.max_m = e->trans_m.max;
  return Done{};
}

Status run_drive(const DriveSpec& spec, AblationDrive& drive) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto surveyed = survey_drive(spec, scratch->path());
  if (!surveyed) return surveyed.error();
  for (std::size_t i = 0; i < variants().size(); ++i) {
    const Status done = run_variant(variants()[i], spec, *surveyed, drive.runs[i]);
    if (!done) return done;
  }
  return Done{};
}

using Series = std::vector<DrivesOfScenario<AblationDrive>>;

nlohmann::ordered_json json_of(const std::vector<AblationDrive>& drives, std::size_t variant) {
  nlohmann::ordered_json j;
  for (const AblationDrive& drive : drives) {
    const VariantRun& run = drive.runs[variant];
    j.push_back({{"seed", drive.seed},
                 {"ate_rmse_m", known(run.rmse_m)},
                 {"max_m", known(run.max_m)},
                 {"coverage", known(run.coverage)}});
    if (!drive.failure.empty()) j.back()["failure"] = drive.failure;
  }
  return j;
}

/// A row, and the same for machines.
nlohmann::ordered_json add_row(const Series& series, std::size_t variant, Table& table) {
  using namespace evaluation;
  const Variant& v = variants()[variant];
  std::vector<std::string> row = {v.name};
  nlohmann::ordered_json j = {
      {"variant", v.key}, {"settings", v.settings}, {"article_rmse_m", known(v.article_rmse_m)}};
  double coverage = 1;
  for (const auto& [scenario, drives] : series) {
    const auto of_run = [&](double VariantRun::*figure) {
      return median_and_worst(
          drives, [&](const AblationDrive& drive) { return drive.runs[variant].*figure; });
    };
    const MedianAndWorst rmse = of_run(&VariantRun::rmse_m);
    const MedianAndWorst max = of_run(&VariantRun::max_m);
    row.push_back(fmt::format("{} / {}", length_text(rmse.median), length_text(rmse.worst)));
    row.push_back(length_text(max.worst));
    for (const AblationDrive& d : drives) coverage = std::min(coverage, d.runs[variant].coverage);
    j["scenarios"].push_back({{"scenario", scenario},
                              {"ate_rmse_median_m", known(rmse.median)},
                              {"ate_rmse_worst_m", known(rmse.worst)},
                              {"max_m", known(max.worst)},
                              {"drives", json_of(drives, variant)}});
  }
  row.push_back(share_text(coverage));
  row.push_back(length_text(v.article_rmse_m));
  table.add_row(row);
  return j;
}

constexpr const char* kNote =
    "\nATE RMSE, median / worst drive, and the largest error of all drives, without alignment; the "
    "odometry is put into the map by the true pose of its first scan. Article: ATE RMSE of Table "
    "7, of the article's own recording of 1910 m, beside ours for the order of the rows only. The "
    "rows from map_filter on are without window and odometry: with all points, with those that "
    "the article's smoothness or ours selects, and with its fits at query time.\n";

}  // namespace

Result<BenchReport> measure_ablation(const BenchOptions& options) {
  const Series series = measure_series<AblationDrive>(kScenarios, options, run_drive);
  BenchReport report;
  std::vector<std::string> header = {"variant"};
  for (const char* scenario : kScenarios) {
    header.push_back(fmt::format("{}: ATE RMSE", scenario));
    header.emplace_back("largest");
  }
  header.emplace_back("coverage, worst");
  header.emplace_back("article");
  Table table(header);
  for (std::size_t i = 0; i < variants().size(); ++i) {
    report.data["results"].push_back(add_row(series, i, table));
  }
  report.markdown = table.markdown() + kNote;
  return report;
}

}  // namespace holdfast::benchmarks
