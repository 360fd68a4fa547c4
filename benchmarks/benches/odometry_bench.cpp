#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/drive_series.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/pose_consistency.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/evaluate.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor",  "office", "hall",  "offices",
                                   "warehouse", "yard",   "tunnel"};
constexpr std::size_t kSettledScans = 5;  // before increments are judged

/// One drive. Where it could not be judged the drift is infinite: a failure is never left out.
struct OdometryDrive : SeriesDrive {
  std::array<double, 3> drift_percent;  ///< over 10, 20 and 50 m
  double ate_m = std::numeric_limits<double>::infinity();
  double path_m = 0;
  int breaks = 0;
  std::size_t scans = 0, weak = 0;  ///< weak: DEGRADED, some direction not determined
  double memory_mb = 0;             ///< of the local map
  std::vector<double> step_ms;
  PoseConsistency increments;  ///< from scan to scan, in axes of the body

  OdometryDrive() { drift_percent.fill(std::numeric_limits<double>::infinity()); }
};

/// Follows a run and keeps what it is judged by.
class Judge {
 public:
  Judge(const simulation::Simulation& simulation, OdometryDrive& drive)
      : simulation_(simulation), drive_(drive) {
    context_.estimate_name = "the odometry";
    context_.is_odometry = true;
  }

  void add(const odometry::OdometryReport& report) {
    const StepReport& step = report.step;
    const SE3 truth = simulation_.truth_at(step.pose_time);
    if (report.increment && drive_.scans >= kSettledScans) add_increment(*report.increment, truth);
    last_truth_ = truth;
    estimate_.push_back({step.pose_time, step.T_map_body});
    evaluation::StepRow row;
    row.pose_time = step.pose_time;
    row.status = "TRACKING";
    row.odom_epoch = step.odom_epoch;
    context_.steps.push_back(row);
    drive_.step_ms.push_back(step.times.total_ms);
    drive_.breaks += report.broke ? 1 : 0;
    drive_.weak += step.state == State::kDegraded ? 1 : 0;
    ++drive_.scans;
  }

  Status finish() {
    evaluation::EvaluationOptions options;
    options.align = evaluation::Alignment::kRigid;
    const auto e = evaluation::evaluate(estimate_, simulation_.truth(), options, context_);
    if (!e) return e.error();
    for (std::size_t i = 0; i < e->drift.size(); ++i) {
      drive_.drift_percent[i] = e->drift[i].drift_percent;
    }
    drive_.ate_m = e->trans_m.rmse;
    drive_.path_m = e->path_m;
    return Done{};
  }

 private:
  void add_increment(const odometry::Increment& increment, const SE3& truth) {
    const SE3 true_way = last_truth_.inverse() * truth;
    PoseConsistency::Error e;
    e << increment.T_prev_cur.translation - true_way.translation,
        so3::log(true_way.rotation.conjugate() * increment.T_prev_cur.rotation);
    drive_.increments.add(e, increment.covariance);
  }

  const simulation::Simulation& simulation_;
  OdometryDrive& drive_;
  evaluation::Trajectory estimate_;
  evaluation::RunContext context_;
  SE3 last_truth_;
};

Status drive_and_judge(const DriveSpec& spec, OdometryDrive& drive) {
  auto simulation = make_drive(spec);
  if (!simulation) return simulation.error();
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto config = load_robot_config(**simulation, spec.settings, scratch->path());
  if (!config) return config.error();
  odometry::Odometry odometry(pipeline::odometry_setup(*config));
  Judge judge(**simulation, drive);
  const auto listen = [&](const odometry::OdometryReport& report, double) -> Status {
    judge.add(report);
    return Done{};
  };
  if (auto done = pipeline::run(**simulation, odometry, listen); !done) return done;
  drive.memory_mb = static_cast<double>(odometry.map().memory_bytes()) / 1e6;
  return judge.finish();
}

nlohmann::ordered_json json_of(const OdometryDrive& d) {
  nlohmann::ordered_json j;
  j["seed"] = d.seed;
  j["drift_10m_percent"] = known(d.drift_percent[0]);
  j["drift_20m_percent"] = known(d.drift_percent[1]);
  j["drift_50m_percent"] = known(d.drift_percent[2]);
  j["ate_rmse_m"] = known(d.ate_m);
  j["path_m"] = known(d.path_m);
  j["breaks"] = d.breaks;
  j["weak_share"] = known(static_cast<double>(d.weak) / static_cast<double>(d.scans));
  j["nees_per_dimension"] = known(d.increments.of_pose());
  for (int axis = 0; axis < PoseConsistency::kDimensions; ++axis) {
    j["nees_by_axis"].push_back(known(d.increments.of_axis(axis)));
  }
  j["memory_mb"] = d.memory_mb;
  j["step_ms"] = json_of(distribution_of(d.step_ms));
  if (!d.failure.empty()) j["failure"] = d.failure;
  return j;
}

std::string percent_text(double percent) {
  return std::isfinite(percent) ? fmt::format("{:.3f} %", percent) : "-";
}

void add_row(const char* scenario, const std::vector<OdometryDrive>& drives, Table& table) {
  using namespace evaluation;
  std::vector<std::string> row = {scenario, count_text(static_cast<double>(drives.size()))};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [median, worst] =
        median_and_worst(drives, [i](const OdometryDrive& d) { return d.drift_percent[i]; });
    row.push_back(fmt::format("{} / {}", percent_text(median), percent_text(worst)));
  }
  const auto ate = median_and_worst(drives, [](const OdometryDrive& d) { return d.ate_m; });
  const auto nees =
      median_and_worst(drives, [](const OdometryDrive& d) { return d.increments.of_pose(); });
  std::vector<double> step_ms;
  double breaks = 0, weak = 0, scans = 0, memory = 0;
  for (const OdometryDrive& d : drives) {
    step_ms.insert(step_ms.end(), d.step_ms.begin(), d.step_ms.end());
    breaks += d.breaks;
    weak += static_cast<double>(d.weak);
    scans += static_cast<double>(d.scans);
    memory = std::max(memory, d.memory_mb);
  }
  const Distribution step = distribution_of(step_ms);
  row.insert(row.end(), {fmt::format("{} / {}", length_text(ate.median), length_text(ate.worst)),
                         fmt::format("{:.2f} / {:.2f}", nees.median, nees.worst),
                         count_text(breaks), share_text(weak / scans), milliseconds_text(step.p50),
                         milliseconds_text(step.p99), memory_text(memory)});
  table.add_row(row);
}

constexpr const char* kNote =
    "\nMedian / worst drive. Drift: mean error of the way over so much of it, without alignment; "
    "ATE after a rigid one. NEES: of the increments from scan to scan, by dimension; 1 is honest. "
    "Weak: scans with a direction that they do not determine. Step: thread CPU time, the first "
    "scans "
    "included. Memory: of the local map.\n";

}  // namespace

Result<BenchReport> measure_odometry(const BenchOptions& options) {
  const auto series = measure_series<OdometryDrive>(kScenarios, options, drive_and_judge);
  BenchReport report;
  Table table({"scenario", "drives", "drift over 10 m", "20 m", "50 m", "ATE RMSE", "NEES",
               "breaks", "weak", "step p50", "p99", "memory"});
  for (const auto& [scenario, drives] : series) {
    nlohmann::ordered_json runs;
    for (const OdometryDrive& drive : drives) runs.push_back(json_of(drive));
    report.data["results"].push_back({{"scenario", scenario}, {"drives", runs}});
    add_row(scenario, drives, table);
  }
  report.markdown = table.markdown() + kNote;
  return report;
}

}  // namespace holdfast::benchmarks
