#include <algorithm>
#include <cmath>

#include "holdfast/odometry/odometry.hpp"
#include "holdfast/odometry/surroundings/local_pairing.hpp"

namespace holdfast::odometry {
namespace {

using filter::FilterState;
using filter::UpdateResult;

constexpr double kAccelerationAtStart = 0.3;  // m/s^2, that levelling takes for gravity
constexpr double kLongestFirstWayM = 3.0;     // between the first two scans
constexpr double kFirstClimbSigma = 0.1;      // m/s, upwards
constexpr double kFirstSlope = 0.1;           // of the ground
constexpr int kPointsOfFirstMap = 6000;
constexpr double kSkewThatMattersM = 0.002;
constexpr TimeNs kQuietFor = kSecond / 10;  // readings that are averaged
constexpr int kLinesAtFirst = 3;            // of a plane, while the motion is not known well

/// Do the measured readings say that the body stands still, or glides evenly?
bool is_quiet(const preprocess::ImuSegment& imu) {
  filter::Rest rest;
  rest.begin();
  preprocess::ImuSegment part;
  for (const ImuSample& s : imu.samples) {
    if (s.t < imu.measured_begin) continue;
    part.samples.push_back(s);
    if (s.t - part.samples.front().t < kQuietFor) continue;
    if (!rest.holds(part)) return false;
    part.samples.clear();
  }
  return true;
}

void set_sigma(FilterState& state, int offset, double sigma) {
  state.P.diagonal().segment<3>(offset).setConstant(sigma * sigma);
}

}  // namespace

void Odometry::begin_anew() {
  phase_ = Phase::kNothing;
  rest_ = {};
  biases_before_hold_.reset();
  ++epoch_;
}

/// The attitude in which the readings up to the end of the first scan point against gravity.
void Odometry::level(const Scan& scan) {
  imu_.segment(scan.end_time - kImuMemory, scan.end_time, segment_);
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double count = 0;
  for (const ImuSample& s : segment_.samples) {
    if (s.t < segment_.measured_begin) continue;
    force += (s.accel_m_s2 - force) / ++count;
  }
  const Eigen::Vector3d up = force.normalized();
  // x of `odom` is the body's x, seen from above.
  Eigen::Vector3d x = Eigen::Vector3d::UnitX() - up.x() * up;
  if (x.norm() < 1e-3) x = Eigen::Vector3d::UnitY() - up.y() * up;
  x.normalize();
  Eigen::Matrix3d R_odom_body;
  R_odom_body << x.transpose(), up.cross(x).transpose(), up.transpose();
  state_ = FilterState{};
  state_.t = scan.end_time;
  state_.T_map_body.rotation = Eigen::Quaterniond(R_odom_body).normalized();
  state_.P.setZero();
  set_sigma(state_, FilterState::kP, 1e-4);
  set_sigma(state_, FilterState::kR, 1e-5);
  set_sigma(state_, FilterState::kV, setup_.fastest_m_s);
  set_sigma(state_, FilterState::kBa, 0.1);
  set_sigma(state_, FilterState::kBg, 0.02);
  first_.may_rest = is_quiet(segment_);
  gravity_.begin(force, kAccelerationAtStart, setup_.gravity_m_s2, state_);
}

/// A local map begins with the first scan that has returns.
void Odometry::wait_for_returns(OdometryReport& report) {
  phase_ = Phase::kWaiting;
  report.step.state = State::kDeadReckoning;
  if (scan_.selected.empty()) {
    report.step.reason = "no returns";
    return;
  }
  keyframes_ = contradictions_ = 0;
  settled_ = false;
  usual_share_ = usual_through_ = 0;
  drift_.setZero();
  map_.set_least_lines(kLinesOfAPlane);
  // The new map is where the robot is; only velocity and biases are uncertain.
  const auto biases = state_.biases();
  const Eigen::Matrix3d P_v = state_.P.block<3, 3>(FilterState::kV, FilterState::kV);
  state_.P.setZero();
  set_sigma(state_, FilterState::kP, 1e-4);
  set_sigma(state_, FilterState::kR, 1e-5);
  state_.P.block<3, 3>(FilterState::kV, FilterState::kV) = P_v;
  state_.set_biases(biases);
  gravity_.forget_pose();
  keep_first_scan();
  jumps_.clear();
  last_surprise_ = report.step.pose_time;
  phase_ = Phase::kFirstScan;
  report.step.state = State::kTracking;
  if (!report.broke) report.step.reason = "first scan of a local map";
}

void Odometry::keep_first_scan() {
  first_.scan = *scan_.scan;
  first_.selected = scan_;
  first_.selected.scan = &first_.scan;
  // With all that it saw: nothing else will stand in the map for a while.
  preprocess::ScanSelectionConfig many = setup_.selection;
  many.max_points = std::max(many.max_points, kPointsOfFirstMap);
  preprocess::select_points(first_.scan, many, scan_number_, first_.selected.selected);
  first_.state = state_;
  find_edges(first_.edges);
  begin_map(first_, Eigen::Vector3d::Zero(), gravity_.value(), map_, work_);
}

/// Of the newest scan.
void Odometry::find_edges(std::vector<SeenEdge>& edges) {
  edge_finder_.find(*scan_.scan, setup_.selection.min_range_m, setup_.selection.max_range_m, edges);
}

/// The way that was found is level: how fast the robot climbs is to be told by what follows.
void Odometry::allow_for_climb() {
  constexpr int kUp = FilterState::kV + 2;
  const double climb = std::hypot(kFirstClimbSigma, kFirstSlope * state_.v_map.norm());
  state_.P.row(kUp).setZero();
  state_.P.col(kUp).setZero();
  state_.P(kUp, kUp) = climb * climb;
}

void Odometry::second_scan(StageClock& clock, OdometryReport& report) {
  const double dt = to_seconds(report.step.pose_time - state_.t);
  FirstMotion motion = FirstMotion::kNone;
  if (!scan_.selected.empty() && dt * setup_.fastest_m_s < kLongestFirstWayM) {
    const LocalPairing pairing(map_, setup_.odometry.parallel_sine, false);
    const filter::UpdateOptions how = options();
    find_edges(edges_);
    motion =
        find_first_motion(first_, scan_, report.step.pose_time, edges_, dt * setup_.fastest_m_s,
                          gravity_.value(), {how, pairing, pool_, map_, work_});
  }
  clock.book(Stage::kStart);
  if (motion == FirstMotion::kNone) {
    predict(report.step.pose_time, report);
    wait_for_returns(report);
    return;
  }
  const bool rests = motion == FirstMotion::kRests && epoch_ == 0;
  if (rests) rest_.begin();
  if (!rests) {
    map_.set_least_lines(kLinesAtFirst);
    begin_map(first_, first_.state.v_map, gravity_.value(), map_, work_);
  }
  state_ = first_.state;
  allow_for_climb();
  Passage passage = pass(report);
  UpdateResult update = correct(clock);
  const Eigen::Vector3d faster = state_.v_map - passage.predicted.v_map;
  if (update.usable && dt * faster.norm() > kSkewThatMattersM) {
    // Once more with the better velocity, which moved the points of both scans.
    first_.state.v_map += faster;
    begin_map(first_, first_.state.v_map, gravity_.value(), map_, work_);
    update = correct_at(0, passage.predicted, clock);
  }
  edge_reference_.clear();
  keep_what_is_left(update, passage);
  correct_by_edges(update, passage);
  phase_ = Phase::kRunning;
  last_keyframe_ = passage.before.T_map_body;
  accept(update, passage, clock, report);
}

}  // namespace holdfast::odometry
