#include "holdfast/odometry/odometry.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "holdfast/filter/account.hpp"
#include "holdfast/odometry/local_reference.hpp"
#include "holdfast/odometry/surroundings/local_pairing.hpp"
#include "holdfast/odometry/surroundings/sight_lines.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::UpdateResult;

constexpr int kFirstKeyframes = 5;    // scans taken at the start though the robot rests
constexpr double kSkewToldM = 0.005;  // skew that is worth being estimated
constexpr double kCoarseFromM = 0.1;  // uncertainty from which coarse planes are asked
constexpr float kCoarseSurfaceSigmaM = 0.05F;
constexpr double kSurprise = 40.0;  // chi-square of 6: once in two million scans
constexpr TimeNs kSettle = kSecond * 3 / 10;
constexpr double kAccelBiasJump = 0.3;  // m/s^2, what a bias may jump by
constexpr double kGyroBiasJump = 0.03;  // rad/s
constexpr double kFewOfUsual = 0.6;     // share of inliers, by the usual one, that is few
constexpr int kContradictions = 3;      // scans in a row until the odometry counts as broken
constexpr double kFitsBetter = 1.02;
constexpr double kFewToLookThrough = 0.8;  // likewise, if the scan looks through walls
constexpr double kThroughWalls = 0.04;     // share of points behind walls, above the usual
constexpr int kLookEvery = 5;              // scans, while all is as usual
constexpr std::size_t kSightLines = 200;
constexpr double kShareMemory = 0.05;
constexpr std::size_t kEnoughPoints = 300;  // to contradict anything
constexpr double kNormalSigma = 0.005;      // rad, common to the normals of a scan
constexpr double kLocalSeconds = 2.0;       // for which a scan meets what was seen before
constexpr int kSettledKeyframes = 10;       // from which it is

preprocess::ScanSelectionConfig selection_of(const Odometry::Setup& setup) {
  preprocess::ScanSelectionConfig selection = setup.selection;
  selection.max_points = std::min(selection.max_points, setup.odometry.max_points);
  selection.least_share = 0;
  return selection;
}

}  // namespace

Odometry::Odometry(const Setup& setup)
    : setup_(setup),
      map_(setup.map, setup.range_sigma_m),
      pool_(setup.threads),
      edge_finder_(setup.range_sigma_m) {
  setup_.selection = selection_of(setup);
  scan_.T_body_lidar = setup.T_body_lidar;
}

filter::UpdateOptions Odometry::options() const {
  filter::UpdateOptions o;
  o.few_pairs = 0;  // a young map has few surfaces: their information is believed
  o.association.gate_m = static_cast<float>(setup_.odometry.gate_m);
  o.association.range_sigma_m = static_cast<float>(setup_.range_sigma_m);
  o.association.surface_sigma_m = static_cast<float>(setup_.odometry.surface_sigma_m);
  o.association.coarser_if_none = false;
  o.robust_scale = setup_.odometry.robust_scale;
  o.map_sigma_m = setup_.odometry.common_sigma_m;
  o.map_sigma_rad = 0.1 * o.map_sigma_m;  // its lever arm is 10 m
  return o;
}

OdometryReport Odometry::add_scan(const Scan& scan) {
  OdometryReport report;
  report.step.stamp = scan.stamp;
  report.step.pose_time = scan.end_time;
  {
    StageClock clock(report.step.times);
    step(scan, clock, report);
    clock.book(Stage::kHealth);
  }
  report.step.T_map_body = state_.T_map_body;
  report.step.odom_epoch = epoch_;
  report.v_odom = state_.v_map;
  ++scan_number_;
  return report;
}

void Odometry::step(const Scan& scan, StageClock& clock, OdometryReport& report) {
  if (!prepare(scan, clock, report)) return;
  if (phase_ == Phase::kNothing) {
    level(scan);
    wait_for_returns(report);
  } else if (phase_ == Phase::kWaiting) {
    predict(scan.end_time, report);
    wait_for_returns(report);
  } else if (phase_ == Phase::kFirstScan) {
    second_scan(clock, report);
  } else {
    track(clock, report);
  }
  imu_.drop_before(scan.end_time - kImuMemory);
}

bool Odometry::prepare(const Scan& scan, StageClock& clock, OdometryReport& report) {
  if (phase_ != Phase::kNothing && scan.end_time <= state_.t) {
    report.step.state = State::kDeadReckoning;
    report.step.reason = "scan is not later than the one before";
    return false;
  }
  if (imu_.empty()) {
    report.step.reason = "no IMU yet";
    return false;
  }
  scan_.scan = &scan;
  preprocess::select_points(scan, setup_.selection, scan_number_, scan_.selected);
  imu_.segment(scan.stamp, scan.end_time, scan_.imu);
  clock.book(Stage::kSelect);
  return true;
}

/// Carries the state to `to`; returns the covariance of the errors there and here.
filter::Matrix15d Odometry::predict(TimeNs to, OdometryReport& report) {
  imu_.segment(state_.t, to, segment_);
  report.step.imu_held_ns = segment_.held_ns;
  const bool holding = segment_.held_ns > filter::kLongestHold;
  if (holding && !biases_before_hold_) biases_before_hold_ = state_.biases();
  if (!holding && biases_before_hold_) {
    state_.set_biases(*biases_before_hold_);
    gravity_.forget_biases();
    biases_before_hold_.reset();
  }
  const FilterState before = state_;
  state_.P.setZero();
  propagate(state_, segment_, gravity_.value(), setup_.imu);
  return gravity_.predict(before, state_);
}

Odometry::Passage Odometry::pass(OdometryReport& report) {
  Passage passage{state_, state_, gravity_, filter::Matrix15d::Zero()};
  passage.now_before = predict(report.step.pose_time, report);
  if (rest_.holds(segment_)) {
    const FilterState moving = state_;
    passage.now_before = filter::Rest::correct(state_) * passage.now_before;
    gravity_.correct(moving, state_);
  }
  passage.predicted = state_;
  return passage;
}

UpdateResult Odometry::correct_at(int level, const FilterState& predicted, StageClock& clock) {
  const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
  filter::UpdateOptions how = options();
  // Walls are parallel to a way that nothing measures only as well as normals are known: while the
  // way is uncertain, they shift sideways by as much.
  const double way = std::min(filter::largest_sigma(predicted.P, FilterState::kP),
                              kLocalSeconds * filter::largest_sigma(predicted.P, FilterState::kV));
  how.map_sigma_m = std::hypot(how.map_sigma_m, kNormalSigma * way);
  how.map_sigma_rad = 0.1 * how.map_sigma_m;
  how.association.level = level;
  // As long as nothing else tells the velocity, the skew of the scan does.
  how.velocity_from_skew = filter::largest_sigma(predicted.P, FilterState::kV) * span > kSkewToldM;
  if (level > 0) {
    const auto reach =
        static_cast<float>(3.0 * filter::largest_sigma(predicted.P, FilterState::kP));
    how.association.gate_m = std::max(how.association.gate_m, reach);
    how.association.surface_sigma_m = kCoarseSurfaceSigmaM;
  }
  return update_with_scan(LocalPairing(map_, setup_.odometry.parallel_sine, settled_), scan_,
                          gravity_.value(), how, pool_, work_, predicted, state_, &clock);
}

UpdateResult Odometry::correct(StageClock& clock) {
  if (scan_.selected.empty()) return {};
  const FilterState predicted = state_;
  const double growth = filter::largest_sigma(predicted.P, FilterState::kP) - sigma_at_scan_m_;
  if (growth > kCoarseFromM) {
    // The pose may be off by more than the finest planes reach: coarser ones lead.
    if (!correct_at(1, predicted, clock).usable) state_ = predicted;
  }
  UpdateResult update = correct_at(0, predicted, clock);
  const double share = update.equations.weight / static_cast<double>(scan_.selected.size());
  update.usable = update.usable && share >= setup_.odometry.min_inlier_share;
  if (!update.usable) state_ = predicted;
  return update;
}

/// The planes' correction left the share I - K H = P P_predicted^-1 of the prediction's errors.
void Odometry::keep_what_is_left(const UpdateResult& update, Passage& passage) const {
  if (!update.usable) return;
  passage.now_before = state_.P * passage.predicted.P.ldlt().solve(passage.now_before);
}

/// Where the planes leave a direction open.
void Odometry::correct_by_edges(const UpdateResult& update, Passage& passage) {
  edge_reference_.follow(passage.before.P, state_.P, passage.now_before);
  if (!edges_on_) edge_reference_.clear();
  if (!edges_on_ || !update.usable ||
      registration::weak_directions(update.equations, setup_.odometry.weak_sigma_m).empty()) {
    return;
  }
  find_edges(edges_);
  edge_reference_.correct(edges_, scan_, gravity_.value(), state_, passage.now_before);
}

/// Squared Mahalanobis distance between the scan's pose and the predicted one.
double Odometry::surprise(const FilterState& predicted) const {
  const Eigen::Matrix<double, 6, 1> moved = state_.minus(predicted).head<6>();
  return moved.dot(predicted.P.topLeftCorner<6, 6>().ldlt().solve(moved));
}

/// The scan fits neither the local map nor the prediction, or looks through walls. A crowd, or a
/// new room, only takes points away.
bool Odometry::contradicted(const UpdateResult& update, double surprise) {
  if (scan_.selected.size() < kEnoughPoints) return false;
  if (!update.usable) return true;
  const double share =
      update.equations.weight / static_cast<double>(scan_.selected.size()) / usual_share_;
  const bool few = share < kFewToLookThrough;
  bool through_walls = false;
  if (few || scan_number_ % kLookEvery == 0) {
    const double through = share_seen_through(map_, work_.points, work_.pairs, state_.T_map_body,
                                              scan_.T_body_lidar.translation, kSightLines);
    through_walls = few && through > kThroughWalls + 3.0 * usual_through_;
    if (!few) usual_through_ += kLookEvery * kShareMemory * (through - usual_through_);
  }
  return through_walls || (surprise > kSurprise && share < kFewOfUsual);
}

/// What the planes told may be for or against a jump of the biases.
void Odometry::hear(const UpdateResult& update, const Passage& passage) {
  if (rest_.is_assumed() || biases_before_hold_) jumps_.clear();
  if (!update.usable) return;
  const double share = update.equations.weight / static_cast<double>(scan_.selected.size());
  jumps_.hear(passage.predicted, state_, share / usual_share_);
}

/// The biases jumped: all that followed from it is put right, as far as its size is known.
void Odometry::allow_for(const BiasJump& jump, Passage& passage) {
  const auto put_right = [&](const Eigen::Matrix<double, 15, 6>& told, FilterState& state) {
    state.add(told * jump.size);
    state.P += told * jump.P * told.transpose();
    state.P = (0.5 * (state.P + state.P.transpose())).eval();
  };
  put_right(jump.before, passage.before);
  put_right(jump.now, state_);
  gravity_.allow_for(jump);
  edge_reference_.allow_for(jump);
  passage.now_before += jump.now * jump.P * jump.before.transpose();
  jumps_.clear();
}

/// A bias may have jumped, or the IMU may be worse than its configured noise: does the scan fit
/// better if the biases are let go? If not, all stays as it was.
UpdateResult Odometry::release_biases(const UpdateResult& update, Passage& passage,
                                      StageClock& clock, OdometryReport& report) {
  const FilterState held = state_;
  const GravityEstimate held_gravity = gravity_;
  last_surprise_ = state_.t;
  state_ = passage.before;
  gravity_ = passage.gravity_before;
  state_.P.diagonal().segment<3>(FilterState::kBa).array() += kAccelBiasJump * kAccelBiasJump;
  state_.P.diagonal().segment<3>(FilterState::kBg).array() += kGyroBiasJump * kGyroBiasJump;
  // The biases may have moved since: errors now and before have that much less in common.
  const filter::Matrix15d predicted_before = predict(report.step.pose_time, report);
  const FilterState predicted = state_;
  clock.book(Stage::kPredict);
  const UpdateResult released = correct(clock);
  if (released.usable && released.equations.weight > kFitsBetter * update.equations.weight) {
    passage.predicted = predicted;
    passage.now_before = predicted_before;
    jumps_.clear();
    return released;
  }
  state_ = held;
  gravity_ = held_gravity;
  return update;
}

void Odometry::track(StageClock& clock, OdometryReport& report) {
  Passage passage = pass(report);
  clock.book(Stage::kPredict);
  const double growth = filter::largest_sigma(state_.P, FilterState::kP) - sigma_at_scan_m_;
  if (growth > setup_.odometry.lost_sigma_m) {
    begin_epoch("too long without a scan that fits", report);
    return;
  }
  jumps_.carry(passage.before, passage.predicted, passage.gravity_before.value(),
               to_seconds(scan_.scan->end_time - scan_.scan->stamp));
  UpdateResult update = correct(clock);
  const double surprised = update.usable ? surprise(passage.predicted) : 0.0;
  if (contradicted(update, surprised)) {
    state_ = passage.predicted;
    update.usable = false;
    if (++contradictions_ >= kContradictions) {
      begin_epoch("scans contradict the local map and the prediction", report);
      return;
    }
  } else {
    contradictions_ = 0;
    if (surprised > kSurprise) rest_.end();
    hear(update, passage);
    if (surprised > kSurprise && state_.t >= last_surprise_ + kSettle) {
      update = release_biases(update, passage, clock, report);
    }
  }
  keep_what_is_left(update, passage);
  correct_by_edges(update, passage);
  accept(update, passage, clock, report);
}

/// What becomes of a scan that was matched, or could not be.
void Odometry::accept(const UpdateResult& update, Passage& passage, StageClock& clock,
                      OdometryReport& report) {
  report.corrected = update.usable;
  if (update.usable) {
    const auto gain = gravity_.correct(passage.predicted, state_);
    jumps_.correct(state_.P * passage.predicted.P.ldlt().solve(filter::Matrix15d::Identity()),
                   gain);
    if (const auto jump = jumps_.believed()) allow_for(*jump, passage);
  }
  add_increment(passage, report);
  describe(update, report);
  map_.follow(state_.T_map_body.translation);
  if (!update.usable) {
    report.step.state = State::kDeadReckoning;
    report.step.reason =
        scan_.selected.empty() ? "no returns" : "the scan does not fit the local map";
    return;
  }
  const filter::Matrix15d change = count_from_here(state_);
  gravity_.change_errors(change);
  jumps_.change_errors(change);
  edge_reference_.change_errors(change);
  sigma_at_scan_m_ = filter::largest_sigma(state_.P, FilterState::kP);
  const double memory = keyframes_ == 0 ? 1.0 : kShareMemory;
  usual_share_ += memory * (report.step.inlier_share - usual_share_);
  const bool weak = !report.step.weak_directions.empty();
  report.step.state = weak ? State::kDegraded : State::kTracking;
  if (weak) report.step.reason = "the scene does not determine every direction";
  extend_map();
  clock.book(Stage::kHealth);
}

void Odometry::extend_map() {
  const SE3 way = last_keyframe_.inverse() * state_.T_map_body;
  const double turn = so3::angle_between(last_keyframe_.rotation, state_.T_map_body.rotation);
  if (keyframes_ >= kFirstKeyframes && way.translation.norm() < setup_.odometry.keyframe_m &&
      turn < setup_.odometry.keyframe_deg * std::numbers::pi / 180.0) {
    return;
  }
  if (keyframes_ == kSettledKeyframes) {
    map_.set_least_lines(kLinesOfAPlane);
    settled_ = true;
  }
  map_.insert(work_.points.points, state_.T_map_body, scan_.T_body_lidar.translation,
              static_cast<std::size_t>(setup_.odometry.max_inserted), scan_number_);
  last_keyframe_ = state_.T_map_body;
  ++keyframes_;
}

void Odometry::begin_epoch(const char* reason, OdometryReport& report) {
  ++epoch_;
  report.broke = true;
  report.step.reason = reason;
  sigma_at_scan_m_ = 0;
  wait_for_returns(report);
}

void Odometry::add_increment(const Passage& passage, OdometryReport& report) {
  const FilterState& before = passage.before;
  Increment increment = increment_between(before, state_, passage.now_before);
  increment.covariance *= setup_.odometry.inflation;
  const SE3 T_epoch{before.T_map_body.rotation, Eigen::Vector3d::Zero()};
  drift_ = compose_covariance(T_epoch, drift_, increment);
  report.increment = increment;
}

void Odometry::describe(const UpdateResult& update, OdometryReport& report) const {
  StepReport& step = report.step;
  filter::report_match(update.equations, scan_.selected.size(), step);
  step.sigma_trans_m = filter::largest_sigma(drift_, 0);
  step.sigma_rot_rad = filter::largest_sigma(drift_, 3);
  if (update.usable) {
    step.weak_directions =
        registration::weak_directions(update.equations, setup_.odometry.weak_sigma_m);
  }
}

}  // namespace holdfast::odometry
