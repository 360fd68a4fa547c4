#include "simulation/motion/person/carry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kMostSpeed = 3;         // m/s
constexpr double kMostAcceleration = 4;  // m/s^2
constexpr double kMostYawRate = 2.5;     // rad/s

constexpr double kLift = 0.5;              // metres at most
constexpr double kLiftShare = 0.25;        // of the time for lifting, and for putting down
constexpr double kLiftAcceleration = 1.5;  // m/s^2
constexpr double kStepHeave = 0.01;        // metres
constexpr double kStepsPerSecond = 1.8;
constexpr double kTilt = 0.07;  // rad
constexpr double kPitchHz = 0.9;
constexpr double kRollHz = 0.6;

/// Greatest second derivative of smooth_step.
constexpr double kStepAcceleration = 5.7735;

double lift_height(double seconds) {
  const double rising = kLiftShare * seconds;
  return std::min(kLift, kLiftAcceleration * rising * rising / kStepAcceleration);
}

}  // namespace

std::vector<PoseVector> carried(const CarryPath& path, std::size_t ticks, TimeNs knot) {
  constexpr double kTwoPi = 2 * std::numbers::pi;
  const double seconds = static_cast<double>(ticks) * to_seconds(knot);
  const double height = lift_height(seconds);
  const Eigen::Vector3d way_begin = path.route.at(path.from_s).position;
  const Eigen::Vector3d way_end = path.route.at(path.from_s + path.way_m).position;
  std::vector<PoseVector> controls;
  for (std::size_t i = 0; i <= ticks; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(ticks);
    const double gone = smooth_step(share);
    const double in_hands = smooth_step(share / kLiftShare) * smooth_step((1 - share) / kLiftShare);
    const double t = share * seconds;
    PoseVector pose = (1 - gone) * path.from + gone * path.to;
    const Eigen::Vector3d straight = (1 - gone) * way_begin + gone * way_end;
    pose.head<3>() += path.route.at(path.from_s + gone * path.way_m).position - straight;
    pose[2] += in_hands * (height + kStepHeave * std::sin(kTwoPi * kStepsPerSecond * t));
    pose[4] += in_hands * kTilt * std::sin(kTwoPi * kPitchHz * t);
    pose[5] += in_hands * kTilt * std::sin(kTwoPi * kRollHz * t);
    controls.push_back(pose);
  }
  return controls;
}

bool is_humanly_possible(const std::vector<PoseVector>& controls, TimeNs knot) {
  const double dt = to_seconds(knot);
  PoseVector last_rate = PoseVector::Zero();
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const bool at_end = i + 1 == controls.size();
    const PoseVector rate =
        at_end ? PoseVector(PoseVector::Zero()) : PoseVector((controls[i + 1] - controls[i]) / dt);
    if (rate.head<3>().norm() > kMostSpeed || std::abs(rate[3]) > kMostYawRate) return false;
    if ((rate - last_rate).head<3>().norm() > kMostAcceleration * dt) return false;
    last_rate = rate;
  }
  return true;
}

}  // namespace holdfast::simulation
