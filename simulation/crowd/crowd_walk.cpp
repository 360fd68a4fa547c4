#include "simulation/crowd/crowd_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

using Eigen::Rotation2Dd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTickSeconds = 0.05;
constexpr double kHaste = 0.8;         // seconds in which a gap to the place aimed at is closed
constexpr double kFastest = 2.2;       // m/s
constexpr double kLeaving = 1.6;       // m/s
constexpr double kAcceleration = 6.0;  // m/s^2

constexpr double kRobotPush = 6;      // m/s for each metre nearer than a member's room
constexpr double kRobotAhead = 0.35;  // seconds for which one foresees the robot
constexpr double kPersonRoom = 0.6;
constexpr double kPersonPush = 3;

constexpr double kStep = 0.2;     // metres up or down from one tick to the next
constexpr double kKnee = 0.6;     // above the ground, to look down from
constexpr double kDoorAfter = 4;  // seconds of leaving
constexpr double kDoorFrom = 3;   // metres from the robot
constexpr double kDoorReach = 8;  // metres
constexpr int kDirections = 16;

/// Velocity away from something at `from`, growing from nothing at `room` metres on.
Vector2d yielding(const Vector2d& place, const Vector2d& from, double room, double push) {
  const Vector2d away = place - from;
  const double distance = away.norm();
  if (distance >= room || distance < 1e-9) return Vector2d::Zero();
  return away * (push * (room - distance) / distance);
}

Vector2d shortened(const Vector2d& v, double most) {
  const double length = v.norm();
  return length > most ? Vector2d(v * (most / length)) : v;
}

/// The nearest wall that does not lie behind the robot.
std::optional<Vector2d> nearest_door(const CrowdMember& member, const CrowdScene& scene,
                                     const Walkable& world) {
  const Vector2d to_robot = (scene.robot - member.place).head<2>().normalized();
  double nearest = kDoorReach;
  std::optional<Vector2d> door;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    if (direction.dot(to_robot) > 0.3) continue;
    const auto wall = world.wall_ahead(member.place, {direction.x(), direction.y(), 0}, nearest);
    if (!wall) continue;
    nearest = *wall;
    door = direction;
  }
  return door;
}

Vector2d aim(const CrowdMember& member, const CrowdScene& scene) {
  const Vector2d robot = scene.robot.head<2>();
  const Vector2d place = member.place.head<2>();
  if (member.door) return kLeaving * *member.door;
  if (member.is_leaving) return kLeaving * (place - robot).normalized();
  const Vector2d goal =
      robot + member.distance * Vector2d(std::cos(member.angle), std::sin(member.angle));
  return scene.robot_velocity + (goal - place) / kHaste;
}

Vector2d wish(const std::vector<CrowdMember>& members, std::size_t i, const CrowdScene& scene) {
  const Vector2d place = members[i].place.head<2>();
  const Vector2d robot = scene.robot.head<2>();
  const double room = members[i].room;
  Vector2d v = shortened(aim(members[i], scene), kFastest);
  v += yielding(place, robot, room, kRobotPush);
  v += yielding(place, robot + kRobotAhead * scene.robot_velocity, room, kRobotPush);
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (k != i) v += yielding(place, members[k].place.head<2>(), kPersonRoom, kPersonPush);
  }
  for (const Vector2d& other : scene.others) v += yielding(place, other, kPersonRoom, kPersonPush);
  return shortened(v, kFastest);
}

/// Where a step with velocity `v` leads, if there is room and ground.
std::optional<Vector3d> stepped(const CrowdMember& member, const Vector2d& v,
                                const Walkable& world) {
  Vector3d to = member.place;
  to.head<2>() += kTickSeconds * v;
  if (member.door) return to;
  const auto ground = world.ground_under(to + Vector3d(0, 0, kKnee), kKnee + kStep);
  if (!ground || *ground > member.place.z() + kStep) return std::nullopt;
  to.z() = *ground;
  if (!world.is_free(member.place, to)) return std::nullopt;
  return to;
}

/// Straight on, or along what is in the way, or not at all.
void step(CrowdMember& member, const Vector2d& wanted, const Walkable& world) {
  const Vector2d change = shortened(wanted - member.velocity, kAcceleration * kTickSeconds);
  const Vector2d v = member.velocity + change;
  constexpr std::array kTurns = {0.0, 0.8, -0.8, 1.5, -1.5};
  for (const double turn : kTurns) {
    const Vector2d turned = Rotation2Dd(turn) * v * std::cos(0.9 * turn);
    const auto to = stepped(member, turned, world);
    if (!to) continue;
    member.place = *to;
    member.velocity = turned;
    return;
  }
  member.velocity.setZero();
}

}  // namespace

void walk_on(std::vector<CrowdMember>& members, const CrowdScene& scene, const Walkable& world) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    CrowdMember& member = members[i];
    if (member.is_leaving) member.left_s += kTickSeconds;
    const double distance = (scene.robot - member.place).head<2>().norm();
    if (member.left_s > kDoorAfter && !member.door && distance > kDoorFrom) {
      member.door = nearest_door(member, scene, world);
    }
    step(member, wish(members, i, scene), world);
  }
}

}  // namespace holdfast::simulation
