#include "simulation/movers/vehicles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "holdfast/core/random.hpp"
#include "simulation/movers/vehicle_drive.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr int kStarts = 60;           // that are tried for each vehicle
constexpr double kPersonRoom = 0.7;   // metres between a vehicle's outline and a person's axis
constexpr double kVehicleRoom = 0.6;  // and another vehicle's outline

Obstacle obstacle_of(const Drive& robot) {
  Obstacle obstacle{{}, kVehicleClearance};
  for (std::size_t tick = 0; tick < VehicleDrive::ticks(robot.duration()); ++tick) {
    const SE3 pose = robot.at(VehicleDrive::tick_time(tick)).T_map_body;
    obstacle.path.push_back(pose.translation);
  }
  return obstacle;
}

Obstacle obstacle_of(const Walkers& people, std::size_t i, TimeNs duration) {
  Obstacle obstacle{{}, kPersonRoom};
  for (std::size_t tick = 0; tick < VehicleDrive::ticks(duration); ++tick) {
    obstacle.path.push_back(people.at(i, VehicleDrive::tick_time(tick)).T_map_body.translation);
  }
  return obstacle;
}

/// A vehicle as discs along its middle, which cover it.
void add_obstacles(const Trajectory& path, const Eigen::Vector2d& size, TimeNs duration,
                   std::vector<Obstacle>& obstacles) {
  const int discs = static_cast<int>(std::ceil(size.x() / size.y()));
  const double step = size.x() / discs;
  const double radius = 0.5 * std::hypot(step, size.y());
  for (int disc = 0; disc < discs; ++disc) {
    const Vector3d ahead((disc + 0.5) * step - 0.5 * size.x(), 0, 0);
    Obstacle obstacle{{}, radius + kVehicleRoom};
    for (std::size_t tick = 0; tick < VehicleDrive::ticks(duration); ++tick) {
      obstacle.path.push_back(path.at(VehicleDrive::tick_time(tick)).T_map_body * ahead);
    }
    obstacles.push_back(std::move(obstacle));
  }
}

/// Slow ones first: those that are driven later look out for those before them, and can wait behind
/// a slower one.
std::vector<std::size_t> order_of(const std::vector<VehiclePlan>& plans) {
  std::vector<std::size_t> order(plans.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return plans[a].speed_m_s < plans[b].speed_m_s;
  });
  return order;
}

std::vector<BodyBox> car_boxes() {
  std::vector<BodyBox> boxes = {{{0, 0, 0.55}, {4.4, 1.75, 0.6}, materials::kPaintedMetal},
                                {{-0.25, 0, 1.125}, {2.3, 1.5, 0.55}, materials::kPaintedMetal}};
  for (const double x : {-1.35, 1.35}) {
    boxes.push_back({{x, 0.75, 0.3}, {0.6, 0.2, 0.6}, materials::kFabric});
    boxes.push_back({{x, -0.75, 0.3}, {0.6, 0.2, 0.6}, materials::kFabric});
  }
  return boxes;
}

std::vector<BodyBox> van_boxes() {
  return {{{-0.6, 0, 1.4}, {4.2, 2.0, 2.1}, materials::kPaintedMetal},
          {{2.1, 0, 0.85}, {1.2, 1.9, 1.0}, materials::kPaintedMetal},
          {{1.9, 0, 1.65}, {0.8, 1.8, 0.6}, materials::kGlass},
          {{1.7, 0, 0.3}, {0.7, 1.95, 0.6}, materials::kFabric},
          {{-1.6, 0, 0.3}, {0.7, 1.95, 0.6}, materials::kFabric}};
}

std::vector<BodyBox> bus_boxes() {
  return {{{0, 0, 0.85}, {11.6, 2.5, 1.1}, materials::kPaintedMetal},
          {{0, 0, 1.9}, {11.4, 2.4, 1.0}, materials::kGlass},
          {{0, 0, 2.7}, {11.6, 2.5, 0.6}, materials::kPaintedMetal},
          {{3.6, 0, 0.45}, {1.0, 2.45, 0.9}, materials::kFabric},
          {{-3.2, 0, 0.45}, {1.0, 2.45, 0.9}, materials::kFabric}};
}

}  // namespace

std::vector<BodyBox> vehicle_boxes(VehicleKind kind) {
  if (kind == VehicleKind::kCar) return car_boxes();
  return kind == VehicleKind::kVan ? van_boxes() : bus_boxes();
}

std::string_view vehicle_name(VehicleKind kind) {
  static constexpr std::array<std::string_view, 3> kNames = {"car", "van", "bus"};
  return kNames[static_cast<std::size_t>(kind)];
}

Eigen::Vector2d vehicle_size(VehicleKind kind) {
  static constexpr std::array kSizes = {std::pair(4.4, 1.75), std::pair(5.4, 2.0),
                                        std::pair(11.6, 2.5)};
  const auto& [length, width] = kSizes[static_cast<std::size_t>(kind)];
  return {length, width};
}

std::vector<Mover> drive_vehicles(const std::vector<VehiclePlan>& plans, const Drive& robot,
                                  const Walkers& people, std::uint64_t seed) {
  std::vector<Mover> out;
  if (plans.empty()) return out;
  std::vector<Obstacle> obstacles = {obstacle_of(robot)};
  for (std::size_t i = 0; i < people.size(); ++i) {
    obstacles.push_back(obstacle_of(people, i, robot.duration()));
  }
  RandomStream random(seed, "vehicles");
  for (const std::size_t i : order_of(plans)) {
    const VehiclePlan& plan = plans[i];
    const VehicleDrive drive(plan.route, plan.speed_m_s, vehicle_size(plan.kind), obstacles);
    std::optional<Trajectory> path;
    for (int tries = 0; tries < kStarts && !path; ++tries) {
      path = drive.from(random.uniform(0, plan.route.length()));
    }
    if (!path) continue;
    add_obstacles(*path, vehicle_size(plan.kind), robot.duration(), obstacles);
    out.push_back({std::move(*path), vehicle_boxes(plan.kind)});
  }
  return out;
}

}  // namespace holdfast::simulation
