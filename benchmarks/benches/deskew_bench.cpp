#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/drive_series.hpp"
#include "benchmarks/drives/filter_run.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "benchmarks/scores/deskew_errors.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/pipeline/event_sequencer.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor", "office"};
constexpr std::array kKeys = {"raw", "deskewed", "true_state", "true_poses"};
constexpr TimeNs kSettled = 3 * kSecond;  // of a drive: the robot stands for 2 s, then sets off
constexpr std::size_t kJudgedEach = 8;    // of the scans on straights; in turns all are judged
constexpr double kStraightRate = 0.1;     // rad/s, at most, from a scan's begin to its end
constexpr double kStraightSpeed = 1.0;    // m/s, at least
constexpr double kTurningRate = 0.8;      // rad/s, at least

/// Table 1 of the article: corridor at 1.2 m/s, mean and standard deviation.
struct ArticleFigures {
  double raw_m = 0.087, raw_deviation_m = 0.021;
  double deskewed_m = 0.009, deskewed_deviation_m = 0.003;
  double raw_edge_m = 0.05, deskewed_edge_m = 0.01;  ///< "blur width"; the second is a bound
  double raw_rmse_m = 0.074, deskewed_rmse_m = 0.028;
};
constexpr ArticleFigures kArticle;

enum class Motion : std::size_t { kStraight, kTurning, kOther };
constexpr std::array kMotions = {"straight", "turning"};

/// The same kind of motion at begin, middle and end of a scan, or kOther.
Motion motion_of(const Scan& scan, const simulation::Simulation& drive, double& rate) {
  bool straight = true;
  bool turning = true;
  rate = 0;
  for (const double share : {0.0, 0.5, 1.0}) {
    const auto t =
        scan.stamp + static_cast<TimeNs>(share * static_cast<double>(scan.end_time - scan.stamp));
    const simulation::TrueState state = drive.state_at(t);
    const double turn = std::abs(state.omega_body.z());
    straight = straight && turn < kStraightRate && state.v_map.norm() > kStraightSpeed;
    turning = turning && turn > kTurningRate;
    rate += turn / 3;
  }
  if (turning) return Motion::kTurning;
  return straight ? Motion::kStraight : Motion::kOther;
}

/// The scans of one kind of motion.
struct Judged {
  std::vector<PlacementErrors> scans;
  std::vector<double> rate_rad_s;

  void add(const Judged& other) {
    scans.insert(scans.end(), other.scans.begin(), other.scans.end());
    rate_rad_s.insert(rate_rad_s.end(), other.rate_rad_s.begin(), other.rate_rad_s.end());
  }
};

struct DriveResult : SeriesDrive {
  std::array<Judged, kMotions.size()> judged;
  double rmse_m = std::numeric_limits<double>::infinity();
  double rmse_raw_m = std::numeric_limits<double>::infinity();  ///< nothing deskewed
};

/// Runs map_filter over the drive and judges scans as it goes, with the state it has after each.
class DeskewJudge {
 public:
  DeskewJudge(const SurveyedDrive& drive, map::PriorMap map, DriveResult& result)
      : drive_(*drive.simulation),
        filter_(std::move(map), pipeline::filter_setup(drive.config), drive.initial_pose),
        result_(result) {}

  Status run() {
    pipeline::EventSequencer sequencer;
    for (bool more = true; more;) {
      auto event = drive_.next();
      if (!event) return event.error();
      more = event->has_value();
      if (more) sequencer.push(std::move(**event));
      if (!more) sequencer.finish();
      for (SensorEvent ready; sequencer.pop(ready);) take(ready);
    }
    return Done{};
  }

 private:
  void take(const SensorEvent& event) {
    if (const auto* imu = std::get_if<ImuSample>(&event)) return filter_.add_imu(*imu);
    const auto& scan = std::get<Scan>(event);
    const StepReport report = filter_.add_scan(scan);
    double rate = 0;
    const Motion motion = motion_of(scan, drive_, rate);
    const bool due = motion == Motion::kTurning || number_++ % kJudgedEach == 0;
    if (scan.stamp < drive_.start_time() + kSettled) return;
    if (motion == Motion::kOther || !due || report.state != State::kTracking) return;
    preprocess::ImuSegment segment;
    filter_.imu().segment(scan.stamp, scan.end_time, segment);
    Judged& judged = result_.judged[static_cast<std::size_t>(motion)];
    judged.scans.push_back(placement_errors(scan, drive_, segment, end_state()));
    judged.rate_rad_s.push_back(rate);
  }

  preprocess::EndState end_state() const {
    const auto& state = filter_.state();
    const Eigen::Quaterniond R_body_map = state.T_map_body.rotation.conjugate();
    const Eigen::Vector3d gravity = filter_.map().info().gravity_map;
    return {R_body_map * state.v_map, R_body_map * gravity, state.gyro_bias, state.accel_bias};
  }

  simulation::Simulation& drive_;
  baselines::MapFilter filter_;
  DriveResult& result_;
  std::size_t number_ = 0;
};

/// A log whose scans claim that all of their points were measured with the last one.
class AllAtOnce : public SensorSource {
 public:
  explicit AllAtOnce(SensorSource& log) : log_(log) {}

  Result<std::optional<SensorEvent>> next() override {
    auto event = log_.next();
    if (!event || !event->has_value()) return event;
    if (auto* scan = std::get_if<Scan>(&**event)) {
      for (ScanPoint& p : scan->points) {
        p.time_offset_ns = static_cast<std::int32_t>(scan->end_time - scan->stamp);
      }
    }
    return event;
  }
  double progress() const override { return log_.progress(); }

 private:
  SensorSource& log_;
};

/// ATE RMSE of `holdfast localize` over a log of the drive; infinite without a claim.
Result<double> rmse_over(SensorSource& log, const SurveyedDrive& drive) {
  const auto steps = localize(log, drive.config, drive.map_dir, drive.initial_pose);
  if (!steps) return steps.error();
  const auto e = judge(*steps, drive.simulation->truth());
  if (!e) return e.error();
  return e->claimed > 0 ? e->trans_m.rmse : std::numeric_limits<double>::infinity();
}

Status measure_drive(const DriveSpec& spec, DriveResult& result) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto drive = survey_drive(spec, scratch->path());
  if (!drive) return drive.error();
  auto map = map::PriorMap::open(drive->map_dir);
  if (!map) return map.error();
  DeskewJudge judge(*drive, std::move(*map), result);
  if (auto done = judge.run(); !done) return done;
  for (const bool raw : {false, true}) {
    const auto again = make_drive(spec);
    if (!again) return again.error();
    AllAtOnce all_at_once(**again);
    const auto rmse = raw ? rmse_over(all_at_once, *drive) : rmse_over(**again, *drive);
    if (!rmse) return rmse.error();
    (raw ? result.rmse_raw_m : result.rmse_m) = *rmse;
  }
  return Done{};
}

/// Mean and spread over scans of one figure of one placement.
struct Spread {
  double mean = 0, deviation = 0, worst = 0;
};

Spread spread_of(const Judged& judged, std::size_t placement, double PlacementError::*figure) {
  double sum = 0;
  double squares = 0;
  double worst = -std::numeric_limits<double>::infinity();
  double n = 0;
  for (const PlacementErrors& scan : judged.scans) {
    const double value = scan[placement].*figure;
    if (!std::isfinite(value)) continue;  // a scan without such points
    sum += value;
    squares += value * value;
    worst = std::max(worst, value);
    ++n;
  }
  const double mean = sum / n;  // NaN for none
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean)), worst};
}

nlohmann::ordered_json json_of(const Spread& s) {
  return {
      {"mean_m", known(s.mean)}, {"std_m", known(s.deviation)}, {"worst_scan_m", known(s.worst)}};
}

constexpr auto kRaw = static_cast<std::size_t>(Placement::kRaw);
constexpr auto kDeskewed = static_cast<std::size_t>(Placement::kDeskewed);
constexpr auto kTruePoses = static_cast<std::size_t>(Placement::kTruePoses);

double ratio_of(const Judged& judged) {
  return spread_of(judged, kDeskewed, &PlacementError::off_surface_m).mean /
         spread_of(judged, kTruePoses, &PlacementError::off_surface_m).mean;
}

nlohmann::ordered_json json_of(const char* scenario, const char* motion, const Judged& judged) {
  nlohmann::ordered_json j = {{"scenario", scenario},
                              {"motion", motion},
                              {"scans", judged.scans.size()},
                              {"yaw_rate_rad_s", known(evaluation::median(judged.rate_rad_s))},
                              {"deskewed_to_true_poses", known(ratio_of(judged))}};
  for (std::size_t k = 0; k < kPlacements; ++k) {
    j[kKeys[k]] = {
        {"off_surface", json_of(spread_of(judged, k, &PlacementError::off_surface_m))},
        {"off_surface_exact", json_of(spread_of(judged, k, &PlacementError::off_surface_exact_m))},
        {"across_edge", json_of(spread_of(judged, k, &PlacementError::across_edge_m))}};
  }
  return j;
}

std::string spread_text(const Spread& s) {
  return fmt::format("{} +- {}", evaluation::length_text(s.mean),
                     evaluation::length_text(s.deviation));
}

void add_row(const char* scenario, const char* motion, const Judged& judged, Table& table) {
  const auto spread = [&](std::size_t placement, double PlacementError::*figure) {
    return spread_of(judged, placement, figure);
  };
  const auto surface = &PlacementError::off_surface_m;
  const auto exact = &PlacementError::off_surface_exact_m;
  const auto edge = &PlacementError::across_edge_m;
  using namespace evaluation;
  table.add_row({fmt::format("{}, {}", scenario, motion),
                 count_text(static_cast<double>(judged.scans.size())),
                 spread_text(spread(kRaw, surface)), spread_text(spread(kDeskewed, surface)),
                 spread_text(spread(kTruePoses, surface)), fmt::format("{:.3f}", ratio_of(judged)),
                 length_text(spread(kRaw, exact).mean), length_text(spread(kDeskewed, exact).mean),
                 length_text(spread(kDeskewed, exact).worst), length_text(spread(kRaw, edge).mean),
                 length_text(spread(kDeskewed, edge).mean),
                 length_text(spread(kTruePoses, edge).mean)});
}

void add_accuracy(const char* scenario, const std::vector<DriveResult>& drives,
                  nlohmann::ordered_json& data, Table& table) {
  std::vector<double> deskewed;
  std::vector<double> raw;
  nlohmann::ordered_json runs;
  for (const DriveResult& drive : drives) {
    deskewed.push_back(drive.rmse_m);
    raw.push_back(drive.rmse_raw_m);
    runs.push_back({{"seed", drive.seed},
                    {"deskewed_m", known(drive.rmse_m)},
                    {"raw_m", known(drive.rmse_raw_m)}});
    if (!drive.failure.empty()) runs.back()["failure"] = drive.failure;
  }
  data.push_back({{"scenario", scenario},
                  {"raw_median_m", known(evaluation::median(raw))},
                  {"raw_worst_m", known(largest(raw))},
                  {"deskewed_median_m", known(evaluation::median(deskewed))},
                  {"deskewed_worst_m", known(largest(deskewed))},
                  {"drives", runs}});
  table.add_row({scenario, evaluation::count_text(static_cast<double>(raw.size())),
                 evaluation::length_text(evaluation::median(raw)),
                 evaluation::length_text(largest(raw)),
                 evaluation::length_text(evaluation::median(deskewed)),
                 evaluation::length_text(largest(deskewed))});
}

/// The article's figures as the first row of each table.
void add_article(nlohmann::ordered_json& data, Table& table, Table& accuracy) {
  using evaluation::length_text;
  const ArticleFigures& a = kArticle;
  data["article_table_1"] = {{"raw_m", a.raw_m},
                             {"raw_std_m", a.raw_deviation_m},
                             {"deskewed_m", a.deskewed_m},
                             {"deskewed_std_m", a.deskewed_deviation_m},
                             {"raw_edge_blur_m", a.raw_edge_m},
                             {"deskewed_edge_blur_below_m", a.deskewed_edge_m},
                             {"raw_ate_rmse_m", a.raw_rmse_m},
                             {"deskewed_ate_rmse_m", a.deskewed_rmse_m}};
  table.add_row({"article, Table 1: corridor", "-", spread_text({a.raw_m, a.raw_deviation_m, 0}),
                 spread_text({a.deskewed_m, a.deskewed_deviation_m, 0}), "-", "-", "-", "-", "-",
                 length_text(a.raw_edge_m), "< " + length_text(a.deskewed_edge_m), "-"});
  accuracy.add_row({"article, Table 1: corridor", "-", length_text(a.raw_rmse_m), "-",
                    length_text(a.deskewed_rmse_m), "-"});
}

constexpr const char* kExplanation =
    "\nMeans of absolute values over the points of a scan, and their mean and standard deviation "
    "over scans. Distance: from the plane of the surface that the ray truly met, for returns {} m "
    "and more from all true edges, of the scan placed by the true pose of its last point. "
    "Deskewed: "
    "from the simulated IMU with its noise and the velocity, attitude and biases that map_filter "
    "has after the scan. Exact ranges: the same rays without range noise. Across edges: along the "
    "surface at right angles to the nearest true edge, for returns within {} m of it. Straight: "
    "below {} rad/s and above {} m/s; turning: above {} rad/s. The article does not say how it "
    "measures; its figure for edges is a blur width.\n";

}  // namespace

Result<BenchReport> measure_deskew(const BenchOptions& options) {
  const auto series = measure_series<DriveResult>(kScenarios, options, measure_drive);
  BenchReport report;
  Table table({"scenario, motion", "scans", "raw", "deskewed", "true poses", "ratio",
               "exact ranges: raw", "deskewed", "worst scan", "across edges: raw", "deskewed",
               "true poses"});
  Table accuracy({"scenario", "drives", "ATE RMSE without deskewing, median", "worst",
                  "with, median", "worst"});
  add_article(report.data, table, accuracy);
  for (const auto& [scenario, drives] : series) {
    for (std::size_t motion = 0; motion < kMotions.size(); ++motion) {
      Judged all;
      for (const DriveResult& drive : drives) all.add(drive.judged[motion]);
      report.data["results"].push_back(json_of(scenario, kMotions[motion], all));
      add_row(scenario, kMotions[motion], all, table);
    }
    add_accuracy(scenario, drives, report.data["accuracy"], accuracy);
  }
  report.markdown = table.markdown() + "\n" + accuracy.markdown();
  report.markdown += fmt::format(kExplanation, kClearOfEdgesM, kAtEdgeM, kStraightRate,
                                 kStraightSpeed, kTurningRate);
  return report;
}

}  // namespace holdfast::benchmarks
