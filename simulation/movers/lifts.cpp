#include "simulation/movers/lifts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/motion/smoothing.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr TimeNs kTick = kSecond / 20;
constexpr std::size_t kMargin = kMeanReach + 6;  // ticks that smoothing and spline need at each end

constexpr double kThick = 0.05;      // metres: walls of the cabin, and doors
constexpr double kDoorTime = 2.0;    // seconds to open or close
constexpr double kOpenBefore = 6.5;  // seconds before the robot stops in the cabin
constexpr double kCloseAfter = 0.6;  // after it has stopped
constexpr double kOpenAfter = 0.6;   // after the cabin has arrived
constexpr double kLeaveTime = 6.0;   // from setting off until the doors close behind the robot
constexpr double kEmptyTrip = 5.0;   // seconds; it ends as the doors begin to open

/// 0 before `begin`, 1 from `seconds` after it on; smooth.
double eased(double t, double begin, double seconds) {
  const double x = std::clamp((t - begin) / seconds, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// What one lift does over a log.
class LiftRun {
 public:
  LiftRun(const LiftPlan& plan, const Drive& robot) : plan_(plan), duration_(robot.duration()) {
    for (const Ride& ride : robot.rides()) {
      const double away = (ride.position.head<2>() - plan.at).norm();
      if (away < 0.5 * plan.length) rides_.push_back(ride);
    }
  }

  void add_to(std::vector<Mover>& movers) const {
    movers.push_back({path([&](double t) { return place(0, 0, height(t)); }), cabin_boxes()});
    for (const double end : {-1.0, 1.0}) {
      const double x = end * 0.5 * (plan_.length + kThick);
      const auto cabin_door = [&](double t) {
        return place(x, slide(openness(t, end)), height(t));
      };
      movers.push_back({path(cabin_door), door_boxes()});
      for (const double floor : plan_.floors) {
        const double landing = end * (0.5 * plan_.length + kLandingGap);
        const auto door = [&](double t) {
          const bool here = std::abs(height(t) - floor) < 0.01;
          return place(landing, slide(here ? openness(t, end) : 0), floor);
        };
        movers.push_back({path(door), door_boxes()});
      }
    }
  }

 private:
  /// A pose at each tick, smoothed as that of the robot is.
  template <class PoseAt>
  Trajectory path(const PoseAt& pose_at) const {
    std::vector<PoseVector> poses;
    const std::size_t ticks = static_cast<std::size_t>(duration_ / kTick) + 2 * kMargin + 2;
    for (std::size_t tick = 0; tick < ticks; ++tick) {
      poses.push_back(pose_at(to_seconds(tick_time(tick))));
    }
    return {tick_time(kMeanReach), kTick, smoothed(std::move(poses))};
  }

  static TimeNs tick_time(std::size_t tick) {
    return (static_cast<TimeNs>(tick) - static_cast<TimeNs>(kMargin)) * kTick;
  }

  PoseVector place(double x, double y, double z) const {
    const double yaw = plan_.yaw_deg * std::numbers::pi / 180;
    const Vector2d at = plan_.at + Eigen::Rotation2Dd(yaw) * Vector2d(x, y);
    PoseVector pose;
    pose << at.x(), at.y(), z, yaw, 0, 0;
    return pose;
  }

  /// Of the cabin's floor.
  double height(double t) const {
    if (rides_.empty()) return plan_.floors.empty() ? 0 : plan_.floors.front();
    double z = rides_.front().position.z();
    for (const Ride& ride : rides_) {
      const double begin = to_seconds(ride.begin);
      const double empty_trip = begin - kOpenBefore - kEmptyTrip;
      z += (ride.position.z() - z) * eased(t, empty_trip, kEmptyTrip);
      z += ride_height(ride.rise_m, t - begin);
    }
    return z;
  }

  /// How far the doors at one end (-1 or 1 along the way through) are open, 0 to 1.
  double openness(double t, double end) const {
    const double yaw = plan_.yaw_deg * std::numbers::pi / 180;
    double open = 0;
    for (const Ride& ride : rides_) {
      const double begin = to_seconds(ride.begin);
      const double leaves = begin + ride_end(ride.rise_m);
      const bool boards_here = std::cos(ride.heading - yaw) * end < 0;
      const double from =
          boards_here ? begin - kOpenBefore : begin + ride_arrival(ride.rise_m) + kOpenAfter;
      const double until = boards_here ? begin + kCloseAfter : leaves + kLeaveTime;
      open = std::max(open, eased(t, from, kDoorTime) - eased(t, until, kDoorTime));
    }
    return open;
  }

  double slide(double open) const { return open * plan_.door_width; }

  std::vector<BodyBox> door_boxes() const {
    const double h = plan_.door_height;
    return {{{0, 0, 0.5 * h}, {kThick, plan_.door_width + 0.04, h}, materials::kPaintedMetal}};
  }

  /// Floor, ceiling, side walls with a hand rail, and what stands beside and above the doors.
  std::vector<BodyBox> cabin_boxes() const {
    const Material metal = materials::kPaintedMetal;
    const double l = plan_.length, w = plan_.width, h = plan_.height;
    const double jamb = 0.5 * (w - plan_.door_width);
    std::vector<BodyBox> boxes = {
        {{0, 0, -0.5 * kThick}, {l + 2 * kThick, w + 2 * kThick, kThick}, materials::kLinoleum},
        {{0, 0, h + 0.5 * kThick}, {l + 2 * kThick, w + 2 * kThick, kThick}, metal}};
    for (const double side : {-1.0, 1.0}) {
      boxes.push_back({{0, side * 0.5 * (w + kThick), 0.5 * h}, {l, kThick, h}, metal});
      const double y = side * 0.5 * (w - jamb);
      for (const double end : {-1.0, 1.0}) {
        const double x = end * 0.5 * (l - kThick);
        boxes.push_back({{x, y, 0.5 * h}, {kThick, jamb, h}, metal});
      }
    }
    boxes.push_back({{0, 0.5 * w - 0.05, 0.9}, {0.7 * l, 0.04, 0.06}, metal});
    boxes.push_back({{-0.3 * l, -0.5 * w + 0.04, 1.2}, {0.25, 0.08, 0.9}, metal});
    const double lintel = h - plan_.door_height;
    for (const double end : {-1.0, 1.0}) {
      boxes.push_back({{end * 0.5 * (l - kThick), 0, h - 0.5 * lintel},
                       {kThick, plan_.door_width, lintel},
                       metal});
    }
    return boxes;
  }

  const LiftPlan& plan_;
  TimeNs duration_;
  std::vector<Ride> rides_;
};

}  // namespace

std::vector<Mover> run_lifts(const std::vector<LiftPlan>& lifts, const Drive& robot) {
  std::vector<Mover> movers;
  for (const LiftPlan& lift : lifts) LiftRun(lift, robot).add_to(movers);
  return movers;
}

World with_closed_doors(const World& world, const std::vector<LiftPlan>& lifts) {
  WorldBuilder build(world);
  for (const LiftPlan& lift : lifts) {
    const Eigen::Rotation2Dd turn(lift.yaw_deg * std::numbers::pi / 180);
    for (const double floor : lift.floors) {
      for (const double end : {-1.0, 1.0}) {
        const double x = end * (0.5 * lift.length + kLandingGap + 0.5 * kThick);
        const double y = end * 0.5 * lift.door_width;
        const Vector2d from = lift.at + turn * Vector2d(x, y);
        const Vector2d to = lift.at + turn * Vector2d(x, -y);
        build.wall({from, to, floor, floor + lift.door_height, materials::kPaintedMetal, {}});
      }
    }
  }
  return build.build();
}

}  // namespace holdfast::simulation
