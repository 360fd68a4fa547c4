#include "baselines/map_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "holdfast/filter/account.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::baselines {
namespace {

constexpr double kMapRadiusM = 150.0;  // tiles farther than this are not needed
constexpr int kScansToConfirm = 2;
constexpr TimeNs kTimeToSettle = kSecond / 4;
constexpr TimeNs kImuMemory = 2 * kSecond;
constexpr double kAccelBiasJump = 0.3;  // m/s^2, what a bias may jump by
constexpr double kGyroBiasJump = 0.03;  // rad/s
constexpr double kClearlyMore = 1.01;
constexpr std::size_t kPointsToChoose = 8000;  // that choose among starts
constexpr double kSkewToldM = 0.04;            // skew that is worth being estimated
constexpr double kCoarseFromM = 0.1;           // uncertainty from which coarse planes are asked
constexpr float kCoarseSurfaceSigmaM = 0.05F;  // while coarse planes are matched

}  // namespace

MapFilter::MapFilter(map::PriorMap map, const Setup& setup, const SE3& T_map_body)
    : map_(std::move(map)), setup_(setup), pool_(setup.threads) {
  state_.T_map_body = T_map_body;
  scan_.T_body_lidar = setup.T_body_lidar;
}

UpdateOptions MapFilter::options() const {
  UpdateOptions o;
  o.association.gate_m = static_cast<float>(setup_.filter.gate_m);
  o.association.range_sigma_m = static_cast<float>(setup_.range_sigma_m);
  o.association.surface_sigma_m = static_cast<float>(setup_.filter.surface_sigma_m);
  o.robust_scale = setup_.filter.robust_scale;
  // The map's own error over the extent of a scan: a share of its noise; its lever arm is 10 m.
  o.map_sigma_m = 0.2 * map_.info().noise_m;
  o.map_sigma_rad = 0.1 * o.map_sigma_m;
  return o;
}

StepReport MapFilter::add_scan(const Scan& scan) {
  StepReport report;
  report.stamp = scan.stamp;
  report.pose_time = scan.end_time;
  {
    StageClock clock(report.times);
    step(scan, clock, report);
    clock.book(Stage::kHealth);
  }
  ++scan_number_;
  return report;
}

void MapFilter::step(const Scan& scan, StageClock& clock, StepReport& report) {
  if (started_ && scan.end_time <= state_.t) {
    report.state = State::kDeadReckoning;
    report.reason = "scan is not later than the one before";
    report.T_map_body = state_.T_map_body;
    return;
  }
  if (imu_.empty()) {
    report.reason = "no IMU yet";
    return;
  }
  scan_.scan = &scan;
  preprocess::select_points(scan, demand_.next(setup_.selection), scan_number_, scan_.selected);
  imu_.segment(scan.stamp, scan.end_time, scan_.imu);
  if (const auto focused = map_.focus(state_.T_map_body.translation, kMapRadiusM); !focused) {
    report.state = State::kLost;
    report.reason = focused.error().message;
    return;
  }
  clock.book(Stage::kSelect);
  if (started_) {
    track(clock, report);
  } else {
    start(report);
    clock.book(Stage::kStart);
  }
  imu_.drop_before(scan.end_time - kImuMemory);
}

void MapFilter::start(StepReport& report) {
  report.imu_held_ns = scan_.imu.held_ns;
  if (scan_.selected.empty()) {
    report.reason = "no returns yet";
    return;
  }
  starts_ = align_initially(map_, scan_, state_, setup_.start, map_.info().gravity_map, options(),
                            pool_, work_);
  std::erase_if(starts_, [&](const StartCandidate& start) {
    return start.inlier_share < setup_.filter.min_inlier_share;
  });
  if (starts_.empty()) {
    report.reason = "the scan does not fit the map near the initial pose";
    return;
  }
  for (StartCandidate& start : starts_) start.state.t = report.pose_time;
  state_ = starts_.front().state;
  report.inlier_share = starts_.front().inlier_share;
  started_ = true;
  start_time_ = report.pose_time;
  confirmed_ = 1;
  report.reason = "first scan aligned";
}

/// The start whose prediction the second scan agrees with best.
void MapFilter::choose_start(StageClock& clock, StepReport& report) {
  double best_weight = -1;
  FilterState best = state_;
  bool best_rests = false;
  const filter::SelectedScan all = std::exchange(scan_, filter::thinned(scan_, kPointsToChoose));
  for (const StartCandidate& start : starts_) {
    state_ = start.state;
    predict(report.pose_time, report);
    const UpdateResult update = correct(clock);
    // The likelier ones come first, and are taken where the scans cannot tell.
    if (!update.usable || update.equations.weight <= kClearlyMore * best_weight) continue;
    best_weight = update.equations.weight;
    best = start.state;
    best_rests = start.rests;
  }
  scan_ = all;
  state_ = best;
  if (best_rests) rest_.begin();
  starts_.clear();
}

bool MapFilter::predict(TimeNs to, StepReport& report) {
  if (!imu_.segment(state_.t, to, segment_)) return false;
  report.imu_held_ns = segment_.held_ns;
  const bool holding = segment_.held_ns > filter::kLongestHold;
  if (holding && !biases_before_hold_) biases_before_hold_ = state_.biases();
  if (!holding && biases_before_hold_) {
    state_.set_biases(*biases_before_hold_);
    biases_before_hold_.reset();
  }
  propagate(state_, segment_, map_.info().gravity_map, setup_.imu);
  if (rest_.holds(segment_)) filter::Rest::correct(state_);
  report.T_map_predicted = state_.T_map_body;
  return true;
}

UpdateResult MapFilter::correct_from(int coarsest, const FilterState& predicted,
                                     StageClock& clock) {
  state_ = predicted;
  // As long as the velocity is hardly known, the skew of the scan tells it best; and a wrong one
  // would displace the pose by half of the skew that it makes up.
  const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
  const bool fast_or_slow = filter::largest_sigma(predicted.P, FilterState::kV) * span > kSkewToldM;
  const bool imu_in_doubt = biases_before_hold_ || predicted.t < last_surprise_ + kSecond;
  UpdateResult update;
  for (int level = coarsest; level >= 0; --level) {
    UpdateOptions how = options();
    how.association.level = level;
    how.velocity_from_skew = fast_or_slow;
    how.motion_from_skew = imu_in_doubt;
    if (level > 0) {
      const auto reach =
          static_cast<float>(3.0 * filter::largest_sigma(predicted.P, FilterState::kP));
      how.association.gate_m = std::max(how.association.gate_m, reach);
      how.association.surface_sigma_m = kCoarseSurfaceSigmaM;
      how.association.ambiguity_sigmas = 0;
    }
    update = update_with_scan(map_, scan_, map_.info().gravity_map, how, pool_, work_, predicted,
                              state_, &clock);
  }
  return update;
}

UpdateResult MapFilter::correct(StageClock& clock) {
  if (scan_.selected.empty()) return {};
  const FilterState predicted = state_;
  const double sigma = filter::largest_sigma(predicted.P, FilterState::kP);
  UpdateResult update = correct_from(0, predicted, clock);
  if (sigma > kCoarseFromM) {
    // The pose may be off by more than the finest planes reach: let coarser ones lead, too.
    const FilterState direct_state = state_;
    const UpdateResult led = correct_from(sigma > 3.0 * kCoarseFromM ? 2 : 1, predicted, clock);
    if (led.equations.weight > kClearlyMore * update.equations.weight) {
      update = led;
    } else {
      state_ = direct_state;
    }
  }
  const double share = update.equations.weight / static_cast<double>(scan_.selected.size());
  update.usable = update.usable && share >= setup_.filter.min_inlier_share;
  if (!update.usable) state_ = predicted;
  return update;
}

/// True where the scan moved the predicted pose by more than the prediction's covariance allows:
/// the squared Mahalanobis distance is chi-square with 6 degrees of freedom at most, and exceeds 40
/// once in two million scans. After a surprise the filter is given a second to settle: velocity and
/// biases that were let go follow the errors of single scans. Likewise after the start.
bool MapFilter::surprised_by_imu(const FilterState& predicted) const {
  constexpr double kSurprise = 40.0;
  constexpr TimeNs kSettle = kSecond * 3 / 10;
  if (state_.t < last_surprise_ + kSettle || state_.t < start_time_ + kSecond) return false;
  const Eigen::Matrix<double, 6, 1> moved = state_.minus(predicted).head<6>();
  return moved.dot(predicted.P.topLeftCorner<6, 6>().ldlt().solve(moved)) > kSurprise;
}

/// A bias may have jumped, or the IMU may be worse than its configured noise: does the scan fit
/// better if the biases are let go? If not, all stays as it was.
UpdateResult MapFilter::release_biases(const FilterState& before, const UpdateResult& update,
                                       StageClock& clock, StepReport& report) {
  const FilterState held = state_;
  last_surprise_ = state_.t;
  rest_.end();
  state_ = before;
  state_.P.diagonal().segment<3>(FilterState::kBa).array() += kAccelBiasJump * kAccelBiasJump;
  state_.P.diagonal().segment<3>(FilterState::kBg).array() += kGyroBiasJump * kGyroBiasJump;
  predict(report.pose_time, report);
  clock.book(Stage::kPredict);
  const UpdateResult released = correct(clock);
  if (released.usable && released.equations.weight > update.equations.weight) return released;
  state_ = held;
  return update;
}

void MapFilter::track(StageClock& clock, StepReport& report) {
  if (!starts_.empty()) choose_start(clock, report);
  const FilterState before = state_;
  predict(report.pose_time, report);
  const FilterState predicted = state_;
  clock.book(Stage::kPredict);
  UpdateResult update = correct(clock);
  if (!update.usable) rest_.end();  // nobody would notice a start too gentle for the IMU
  if (update.usable && surprised_by_imu(predicted))
    update = release_biases(before, update, clock, report);
  if (update.usable) demand_.learn(update.equations, scan_.selected.size(), setup_.selection);
  describe(update, report);
  judge(update, report);
}

void MapFilter::describe(const UpdateResult& update, StepReport& report) const {
  report.T_map_body = state_.T_map_body;
  filter::report_match(update.equations, scan_.selected.size(), report);
  filter::report_covariance(state_.P.topLeftCorner<6, 6>(), report);
  if (update.usable) {
    report.weak_directions =
        registration::weak_directions(update.equations, setup_.filter.weak_sigma_m);
  }
}

void MapFilter::judge(const UpdateResult& update, StepReport& report) {
  confirmed_ += update.usable ? 1 : 0;
  if (confirmed_ < kScansToConfirm || report.pose_time < start_time_ + kTimeToSettle) {
    report.state = State::kInitializing;
    report.reason = "waiting for scans that agree and for the velocity to settle";
  } else if (report.sigma_trans_m > setup_.filter.lost_sigma_m) {
    report.state = State::kLost;
    report.reason = "too long without a scan that fits the map";
  } else if (!update.usable) {
    report.state = State::kDeadReckoning;
    report.reason = scan_.selected.empty() ? "no returns" : "the scan does not fit the map";
  } else if (!report.weak_directions.empty()) {
    report.state = State::kDegraded;
    report.reason = "the scene does not determine every direction";
  } else {
    report.state = State::kTracking;
  }
}

}  // namespace holdfast::baselines
