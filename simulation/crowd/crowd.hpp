#pragma once

#include <cstdint>
#include <vector>

#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/world/ray_caster.hpp"
#include "simulation/world/walkers.hpp"

namespace holdfast::simulation {

/// When a crowd of that span is complete: a quarter of it, but 2.5 s at most, goes by for coming
/// and as much for going.
TimeSpan densest(const TimeSpan& crowd);

/// Who comes, and how near: a ring of people round the robot and one further out.
struct CrowdPlan {
  TimeSpan span;
  std::size_t inner = 12;
  std::size_t outer = 20;
  double nearest_m = 1.0;   ///< of the inner ring, from the robot's axis
  double farthest_m = 1.3;  ///< likewise
  double room_m = 1.1;      ///< nearer than that they yield to the robot
};

/// Up to 32 people who, when the crowd of the plan's span is densest, walk round the robot and with
/// it, in a ring of about 1.2 m and one of 2.2 m (or as the plan says), where the world leaves them
/// room. Before and after it they keep away from the robot; they are there from when until when
/// nobody could see them: as something hid them or they were more than 25 m away. Where a room has
/// no such place they come and go through a wall at least 3 m from the robot, as if it had a door.
/// They keep clear of the robot, of each other, of `others` and of walls; whoever cannot stay 0.5 m
/// from the robot's axis does not come. `eye` is where the LiDAR sits in the body's frame; `world`
/// is the static world.
std::vector<Passer> gather_crowd(const CrowdPlan& plan, const Drive& robot,
                                 const Eigen::Vector3d& eye, const Walkers& others,
                                 const RayCaster& world, std::uint64_t seed);

}  // namespace holdfast::simulation
