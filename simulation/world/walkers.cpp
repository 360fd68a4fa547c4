#include "simulation/world/walkers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr TimeNs kTick = kSecond / 20;
constexpr double kTickSeconds = 0.05;
constexpr std::size_t kMargin = kMeanReach + 6;  // ticks that smoothing and spline need at each end
constexpr double kRobotClearance = 0.75;         // metres between the axes of person and robot
constexpr double kPersonClearance = 0.5;         // and of two people
constexpr std::size_t kLookAhead = 30;           // ticks

constexpr double kHip = 0.85;
constexpr double kStepsPerSecond = 0.9;  // swings of one leg
constexpr double kStride = 0.25;         // swing of a foot to each side of the hip at 0.8 m/s

constexpr double kMostStride = 0.4;  // from 1.3 m/s on

/// Someone or something to keep away from: where it is at each tick (the first is kMargin ticks
/// before the log), and how far its axis must stay away.
struct Obstacle {
  std::vector<Vector2d> path;
  double clearance;
};

Obstacle robot_obstacle(const Drive& robot) {
  Obstacle obstacle{{}, kRobotClearance};
  const std::size_t ticks = static_cast<std::size_t>(robot.duration() / kTick) + 2 * kMargin + 2;
  for (std::size_t i = 0; i < ticks + kLookAhead; ++i) {
    const TimeNs t = (static_cast<TimeNs>(i) - static_cast<TimeNs>(kMargin)) * kTick;
    obstacle.path.push_back(robot.at(t).T_map_body.translation.head<2>());
  }
  return obstacle;
}

/// Walks one person along its route, tick by tick, out of the way of robot and people.
class Walk {
 public:
  Walk(const WalkerPlan& plan, const std::vector<Obstacle>& obstacles)
      : plan_(plan), obstacles_(obstacles), ticks_(obstacles.front().path.size()) {}

  /// Room at the start when beginning at `s`, in metres beyond what is needed.
  double room_at_start(double s) const { return room(0, s, 0); }

  /// Where the person is at each tick, as pose vectors.
  std::vector<PoseVector> places(double s) const {
    std::vector<PoseVector> out;
    for (std::size_t tick = 0; tick < ticks_; ++tick) {
      const Route::Place place = plan_.route.at(s);
      PoseVector pose;
      pose << place.position, place.heading, 0, 0;
      out.push_back(pose);
      s += pace(tick, s) * kTickSeconds;
    }
    return out;
  }

 private:
  /// On, if there is room; else to stand or to step back, whichever leaves more.
  double pace(std::size_t tick, double s) const {
    double best_pace = plan_.speed_m_s;
    double best = room(tick, s, best_pace);
    for (const double candidate : {0.0, -plan_.speed_m_s}) {
      if (best >= 0) break;
      const double there = room(tick, s, candidate);
      if (there <= best + 1e-6) continue;
      best = there;
      best_pace = candidate;
    }
    return best_pace;
  }

  /// Least room over the time ahead when walking on from `s` at `pace`.
  double room(std::size_t tick, double s, double pace) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t ahead = 0; ahead < kLookAhead && tick + ahead < ticks_; ahead += 3) {
      const double there = s + pace * kTickSeconds * static_cast<double>(ahead);
      const Vector2d p = plan_.route.at(there).position.head<2>();
      for (const Obstacle& obstacle : obstacles_) {
        least = std::min(least, (p - obstacle.path[tick + ahead]).norm() - obstacle.clearance);
      }
    }
    return least;
  }

  const WalkerPlan& plan_;
  const std::vector<Obstacle>& obstacles_;
  std::size_t ticks_;
};

Capsule limb(const MotionState& body, const Vector3d& from, const Vector3d& to, double radius) {
  return {body.T_map_body * from, body.T_map_body * to, radius, body.v_map};
}

}  // namespace

Walkers::Walkers(const std::vector<WalkerPlan>& plans, const Drive& robot, std::uint64_t seed) {
  if (plans.empty()) return;
  std::vector<Obstacle> obstacles = {robot_obstacle(robot)};
  RandomStream random(seed, "walkers");
  for (const WalkerPlan& plan : plans) {
    const bool backwards = random.below(2) == 1;
    const WalkerPlan way{backwards ? plan.route.reversed() : plan.route, plan.speed_m_s};
    const Walk walk(way, obstacles);
    double s = random.uniform(0, way.route.length());
    for (int tries = 0; tries < 50 && walk.room_at_start(s) < 0.3; ++tries) {
      s = random.uniform(0, way.route.length());
    }
    std::vector<PoseVector> places = walk.places(s);
    Obstacle person{{}, kPersonClearance};
    for (const PoseVector& place : places) person.path.emplace_back(place.head<2>());
    obstacles.push_back(std::move(person));
    const TimeNs begin = (static_cast<TimeNs>(kMeanReach) - static_cast<TimeNs>(kMargin)) * kTick;
    people_.push_back({Trajectory(begin, kTick, smoothed(std::move(places))),
                       random.uniform(0, 2 * std::numbers::pi), std::nullopt});
  }
}

void Walkers::join(const std::vector<Passer>& passers) {
  for (const Passer& passer : passers) {
    people_.push_back({passer.path, passer.step_phase, passer.present});
  }
}

MotionState Walkers::at(std::size_t i, TimeNs t) const { return people_[i].path.at(t); }

void Walkers::shapes_at(TimeNs t, std::vector<Capsule>& shapes) const {
  shapes.clear();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    if (!is_there(i, t)) continue;
    const Person& person = people_[i];
    const MotionState body = person.path.at(t);
    shapes.push_back(limb(body, {0, 0, 0.95}, {0, 0, 1.38}, 0.18));
    shapes.push_back(limb(body, {0, 0, 1.60}, {0, 0, 1.66}, 0.11));
    const double angle = 2 * std::numbers::pi * kStepsPerSecond * to_seconds(t) + person.step_phase;
    const double stride = std::min(kStride * body.v_map.norm() / 0.8, kMostStride);
    for (const double side : {1.0, -1.0}) {
      const double swing = side * stride * std::sin(angle);
      shapes.push_back(limb(body, {0, side * 0.09, kHip}, {swing, side * 0.09, 0.08}, 0.075));
      const double swing_speed =
          side * stride * 2 * std::numbers::pi * kStepsPerSecond * std::cos(angle);
      shapes.back().velocity += body.T_map_body.rotation * Vector3d(0.5 * swing_speed, 0, 0);
    }
  }
}

}  // namespace holdfast::simulation
