#include "holdfast/odometry/first_motion.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::odometry {
namespace {

using filter::FilterState;

constexpr double kStepM = 0.3;
constexpr double kSearchSigmaM = 0.2;
constexpr double kFirstMapSigmaM = 0.005;  // error of a map of one scan, common to its points
constexpr double kRestSigmaM = 0.003;
constexpr double kTurnSigma = 0.003;   // rad, of the gyroscope over a scan
constexpr double kClimbSigmaM = 0.03;  // likewise upwards: robots hardly climb
constexpr double kFelt = 30.0;         // squared sigmas from which a way is none of the noise
constexpr std::size_t kSearchPoints = 1500;
constexpr double kBetter = 40.0;      // squared sigmas by which a faster motion must explain more
constexpr double kNothing = 1e12;     // cost of what cannot be matched
constexpr double kLeastShare = 0.15;  // of the points that must agree

/// Displacements in the horizontal plane, shortest first; the guess after rest.
std::vector<Eigen::Vector3d> displacements(const Eigen::Vector3d& guess, double longest) {
  std::vector<Eigen::Vector3d> all;
  const int steps = static_cast<int>(std::ceil(longest / kStepM));
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      const Eigen::Vector3d d(kStepM * i, kStepM * j, 0);
      if (d.norm() <= longest + 0.5 * kStepM) all.push_back(d);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  // Rest before all.
  if (guess.norm() > 0) all.insert(all.begin() + 1, guess);
  return all;
}

void set_sigma(FilterState& state, int offset, double sigma) {
  state.P.diagonal().segment<3>(offset).setConstant(sigma * sigma);
}

/// Where the second scan ends, as the gyroscope turns, displaced by `d` and standing still, so that
/// the scan stays as skewed as the first one is.
FilterState displaced(const FirstScan& first, const SE3& turned, const Eigen::Vector3d& d,
                      double sigma_m) {
  FilterState state = first.state;
  state.T_map_body = {turned.rotation, first.state.T_map_body.translation + d};
  state.v_map.setZero();
  state.P.setZero();
  set_sigma(state, FilterState::kP, sigma_m);
  const double climb_m = std::min(sigma_m, kClimbSigmaM);
  state.P(FilterState::kP + 2, FilterState::kP + 2) = climb_m * climb_m;
  set_sigma(state, FilterState::kR, kTurnSigma);
  set_sigma(state, FilterState::kV, 1e-3);
  set_sigma(state, FilterState::kBa, 1e-3);
  set_sigma(state, FilterState::kBg, 1e-4);
  return state;
}

/// The pose after `dt` of turning at the mean rate of the readings.
SE3 turned_by(const preprocess::ImuSegment& imu, double dt, const FilterState& from) {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu.samples) rate += s.gyro_rad_s - from.gyro_bias;
  rate /= static_cast<double>(std::max<std::size_t>(imu.samples.size(), 1));
  return {(from.T_map_body.rotation * so3::exp(dt * rate)).normalized(),
          from.T_map_body.translation};
}

filter::SelectedScan thinned(const filter::SelectedScan& scan) {
  filter::SelectedScan few = scan;
  const std::size_t n = scan.selected.size();
  if (n <= kSearchPoints) return few;
  few.selected.resize(kSearchPoints);
  for (std::size_t k = 0; k < kSearchPoints; ++k) {
    few.selected[k] = scan.selected[k * n / kSearchPoints];
  }
  return few;
}

}  // namespace

void FirstScan::keep(const filter::SelectedScan& from, const FilterState& at) {
  scan = *from.scan;
  selected = from;
  selected.scan = &scan;
  state = at;
  kept = true;
}

void begin_map(const FirstScan& first, const Eigen::Vector3d& gravity, LocalMap& map,
               filter::UpdateWorkspace& work) {
  const FilterState& s = first.state;
  const Eigen::Quaterniond R_body_odom = s.T_map_body.rotation.conjugate();
  work.motion.set(first.selected.imu,
                  {R_body_odom * s.v_map, R_body_odom * gravity, s.gyro_bias, s.accel_bias},
                  first.selected.T_body_lidar, first.scan.stamp, first.scan.end_time);
  work.points.resize(first.selected.selected.size());
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    work.points.points[i] = work.motion.deskew(first.scan.points[first.selected.selected[i]]);
  }
  map.clear();
  map.follow(s.T_map_body.translation);
  map.insert(work.points.points, s.T_map_body, first.selected.T_body_lidar.translation);
}

FirstMotion find_first_motion(FirstScan& first, const filter::SelectedScan& second,
                              TimeNs second_end, double fastest_m_s, const Eigen::Vector3d& gravity,
                              const filter::UpdateOptions& options,
                              const filter::ScanPairing& pairing, WorkerPool& pool, LocalMap& map,
                              filter::UpdateWorkspace& work) {
  const double dt = to_seconds(second_end - first.state.t);
  const Eigen::Vector3d guess = dt * first.state.v_map;
  first.state.v_map.setZero();
  begin_map(first, gravity, map, work);
  const SE3 turned = turned_by(second.imu, dt, first.state);
  filter::UpdateOptions few_steps = options;
  few_steps.max_iterations = 5;
  few_steps.map_sigma_m = kFirstMapSigmaM;
  const filter::SelectedScan few = thinned(second);
  FilterState state;
  const auto cost_of = [&](const Eigen::Vector3d& d, double sigma_m) {
    const FilterState prior = displaced(first, turned, d, sigma_m);
    state = prior;
    const auto result = filter::update_with_scan(pairing, few, gravity, few_steps, pool, work,
                                                 prior, state, nullptr);
    const auto n = static_cast<double>(few.selected.size());
    if (!result.usable || result.equations.weight < kLeastShare * n) return kNothing;
    // Points without a pair cost as much as those that are far off.
    const double most = few_steps.robust_scale * few_steps.robust_scale;
    return result.equations.cost + most * (n - result.equations.pairs);
  };
  const double resting = cost_of(Eigen::Vector3d::Zero(), kRestSigmaM);
  double least = kNothing;
  FirstMotion motion = FirstMotion::kNone;
  Eigen::Vector3d best_way = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& d : displacements(guess, dt * fastest_m_s)) {
    const double cost = cost_of(d, kSearchSigmaM);
    if (cost >= kNothing || cost > least - kBetter) continue;
    least = cost;
    best_way = state.T_map_body.translation - first.state.T_map_body.translation;
    motion = FirstMotion::kMoves;
    const Eigen::Matrix3d P = state.P.topLeftCorner<3, 3>();
    if (best_way.dot(P.ldlt().solve(best_way)) > kFelt && cost < resting) continue;
    motion = FirstMotion::kRests;
    best_way.setZero();
  }
  // Where floor and ceiling are hardly seen, the height that fits best is noise.
  first.state.v_map = {best_way.x() / dt, best_way.y() / dt, 0};
  begin_map(first, gravity, map, work);
  return motion;
}

}  // namespace holdfast::odometry
