#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "simulation/crowd/walkable.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/world/walkers.hpp"

namespace holdfast::simulation {

inline constexpr TimeNs kCrowdTick = kSecond / 20;

/// Someone of a crowd at one tick.
struct CrowdMember {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     ///< on the ground
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< in the direction in which time is walked
  double angle = 0;     ///< of the place round the robot that is aimed at, in the map
  double distance = 0;  ///< of that place from the robot
  double room = 1.1;    ///< metres from the robot's axis at which one begins to yield to it
  bool is_leaving = false;
  double left_s = 0;                    ///< seconds since
  std::optional<Eigen::Vector2d> door;  ///< direction of the wall to go through
};

/// What surrounds a crowd at one tick.
struct CrowdScene {
  Eigen::Vector3d robot = Eigen::Vector3d::Zero();
  Eigen::Vector2d robot_velocity = Eigen::Vector2d::Zero();  ///< likewise
  std::vector<Eigen::Vector2d> others;                       ///< people who are no part of it
};

/// Moves the members one tick on: those who are with the robot towards their places round it, those
/// who are leaving away from it. All keep clear of the robot, each other, the others and walls.
void walk_on(std::vector<CrowdMember>& members, const CrowdScene& scene, const Walkable& world);

}  // namespace holdfast::simulation
