#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/drive_series.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/pose_consistency.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor",  "office", "hall",  "offices",
                                   "warehouse", "yard",   "tunnel"};
constexpr std::array<const char*, 2> kMethods = {"map_filter", "graph"};
constexpr std::array kAxes = {"x", "y", "z", "roll", "pitch", "yaw"};
constexpr TimeNs kWarmUp = 2 * kSecond;  // as for all shares of an evaluation
constexpr double kLeast = 0.5;           // asked for, of each axis
constexpr double kMost = 2.0;

/// One run of one method.
struct MethodRun {
  PoseConsistency errors;        ///< of the claims after the warm-up, in axes of the body
  std::size_t scans = 0;         ///< after the warm-up
  std::size_t uncovered = 0;     ///< claims without a covariance
  std::vector<double> of_scans;  ///< squared error by covariance, by scan; NaN without a claim
};

struct ConsistencyDrive : SeriesDrive {
  std::array<MethodRun, kMethods.size()> runs;
};

/// Methods that are not to be left out.
std::vector<std::size_t> methods_of(const std::vector<std::string>& settings) {
  std::vector<std::size_t> methods;
  const auto chosen = std::find_if(settings.rbegin(), settings.rend(),
                                   [](const auto& s) { return s.starts_with("method="); });
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    if (chosen == settings.rend() || chosen->ends_with(std::string("=") + kMethods[i])) {
      methods.push_back(i);
    }
  }
  return methods;
}

void judge(const std::vector<StepReport>& steps, const simulation::Simulation& drive,
           MethodRun& run) {
  for (const StepReport& step : steps) {
    if (step.pose_time < steps.front().pose_time + kWarmUp) continue;
    ++run.scans;
    run.of_scans.push_back(evaluation::kNotKnown);
    if (!claims_pose(step.state)) continue;
    if (step.pose_covariance.isZero()) {
      ++run.uncovered;
      continue;
    }
    const SE3 truth = drive.truth_at(step.pose_time);
    const Eigen::Matrix3d R_body_map = step.T_map_body.rotation.conjugate().toRotationMatrix();
    PoseConsistency::Error error;
    error.head<3>() = R_body_map * (step.T_map_body.translation - truth.translation);
    error.tail<3>() = so3::log(truth.rotation.conjugate() * step.T_map_body.rotation);
    PoseConsistency::Covariance to_body = PoseConsistency::Covariance::Identity();
    to_body.topLeftCorner<3, 3>() = R_body_map;
    run.errors.add(error, to_body * step.pose_covariance * to_body.transpose());
    run.of_scans.back() = run.errors.squares().back();
  }
}

Status run_drive(const DriveSpec& spec, ConsistencyDrive& drive) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto surveyed = survey_drive(spec, scratch->path());
  if (!surveyed) return surveyed.error();
  for (const std::size_t method : methods_of(spec.settings)) {
    const auto log = make_drive(spec);
    if (!log) return log.error();
    pipeline::Config config = surveyed->config;
    config.method = kMethods[method];
    const auto steps = localize(**log, config, surveyed->map_dir, surveyed->initial_pose);
    if (!steps) return steps.error();
    judge(*steps, *surveyed->simulation, drive.runs[method]);
  }
  return Done{};
}

/// The runs of one method in one scenario.
struct MethodScore {
  PoseConsistency all;
  std::vector<double> of_drives;  ///< NEES of each; infinite where nothing can be judged
  std::size_t scans = 0, uncovered = 0, failed = 0;
  double mean_in_band = evaluation::kNotKnown;

  double claimed() const {
    return static_cast<double>(all.instants()) / static_cast<double>(scans);
  }
  /// Every axis as asked for.
  bool as_asked() const {
    for (int axis = 0; axis < PoseConsistency::kDimensions; ++axis) {
      if (!(all.of_axis(axis) >= kLeast && all.of_axis(axis) <= kMost)) return false;
    }
    return failed == 0;
  }
};

/// Share of the scans at which the mean over all drives lies in the band of such a mean.
double share_of_means_in_band(const std::vector<const MethodRun*>& runs) {
  const auto n = static_cast<int>(runs.size());
  if (n == 0) return evaluation::kNotKnown;
  const Band band = chi_square_band_95(PoseConsistency::kDimensions * n);
  evaluation::Share share;
  std::size_t scans = runs.front()->of_scans.size();
  for (const MethodRun* run : runs) scans = std::min(scans, run->of_scans.size());
  for (std::size_t i = 0; i < scans; ++i) {
    double sum = 0;
    for (const MethodRun* run : runs) sum += run->of_scans[i];
    share.add(band.holds(sum));  // never with a NaN: a drive without a claim
  }
  return share.value();
}

MethodScore score_of(const std::vector<ConsistencyDrive>& drives, std::size_t method) {
  MethodScore score;
  std::vector<const MethodRun*> runs;
  for (const ConsistencyDrive& drive : drives) {
    const MethodRun& run = drive.runs[method];
    const bool judged = drive.failure.empty() && run.errors.instants() > 0;
    score.all.add(run.errors);
    score.scans += run.scans;
    score.uncovered += run.uncovered;
    score.failed += judged ? 0 : 1;
    score.of_drives.push_back(judged ? run.errors.of_pose()
                                     : std::numeric_limits<double>::infinity());
    runs.push_back(&run);
  }
  score.mean_in_band = share_of_means_in_band(runs);
  return score;
}

nlohmann::ordered_json json_of(const char* method, const MethodScore& s,
                               const std::vector<ConsistencyDrive>& drives) {
  nlohmann::ordered_json j = {{"method", method},
                              {"nees", known(s.all.of_pose())},
                              {"nees_position", known(s.all.of_position())},
                              {"nees_rotation", known(s.all.of_rotation())}};
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    j["nees_by_axis"][kAxes[axis]] = known(s.all.of_axis(static_cast<int>(axis)));
  }
  j["instants"] = s.all.instants();
  j["claimed"] = known(s.claimed());
  j["in_band"] = known(s.all.share_in_band());
  j["mean_over_drives_in_band"] = known(s.mean_in_band);
  j["as_asked"] = s.as_asked();
  j["claims_without_covariance"] = s.uncovered;
  j["failed"] = s.failed;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    j["drives"].push_back({{"seed", drives[i].seed}, {"nees", known(s.of_drives[i])}});
    if (!drives[i].failure.empty()) j["drives"].back()["failure"] = drives[i].failure;
  }
  return j;
}

std::string nees_text(double nees) {
  if (!std::isfinite(nees)) return "-";
  return nees < 99.995 ? fmt::format("{:.2f}", nees) : evaluation::count_text(nees);
}

void add_row(const char* scenario, const char* method, const MethodScore& s, Table& table) {
  using namespace evaluation;
  std::vector<std::string> row = {fmt::format("{}, {}", scenario, method),
                                  count_text(static_cast<double>(s.of_drives.size()))};
  for (const double nees :
       {s.all.of_pose(), largest(s.of_drives), s.all.of_position(), s.all.of_rotation()}) {
    row.push_back(nees_text(nees));
  }
  for (int axis = 0; axis < PoseConsistency::kDimensions; ++axis) {
    row.push_back(nees_text(s.all.of_axis(axis)));
  }
  row.insert(row.end(), {s.as_asked() ? "yes" : "no", share_text(s.all.share_in_band()),
                         share_text(s.mean_in_band), share_text(s.claimed())});
  table.add_row(row);
}

constexpr const char* kNote =
    "\nNEES: squared error by the reported covariance, by dimension; 1 is honest, more is too "
    "sure, less too careful. Means over all claims from {} s on, the worst drive beside them; axes "
    "of the body. Asked for: {} to {} on each axis. In the band: single claims whose NEES lies in "
    "the middle 95 % of chi-square with 6 degrees of freedom, and scans at which the mean over the "
    "drives lies in that of such a mean; asked for: 90 % in the corridor.\n";

}  // namespace

Result<BenchReport> measure_consistency(const BenchOptions& options) {
  const auto series = measure_series<ConsistencyDrive>(kScenarios, options, run_drive);
  BenchReport report;
  Table table({"scenario, method", "drives", "NEES", "worst drive", "position", "rotation", "x",
               "y", "z", "roll", "pitch", "yaw", "as asked", "in the band", "means in the band",
               "claimed"});
  for (const auto& [scenario, drives] : series) {
    nlohmann::ordered_json methods;
    for (const std::size_t method : methods_of(options.settings)) {
      const MethodScore score = score_of(drives, method);
      methods.push_back(json_of(kMethods[method], score, drives));
      add_row(scenario, kMethods[method], score, table);
    }
    report.data["results"].push_back({{"scenario", scenario}, {"methods", methods}});
  }
  report.markdown = table.markdown() + fmt::format(kNote, to_seconds(kWarmUp), kLeast, kMost);
  return report;
}

}  // namespace holdfast::benchmarks
