#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "simulation/motion/drive.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/world/walkers.hpp"

namespace holdfast::simulation {

enum class VehicleKind { kCar, kVan, kBus };

inline constexpr std::array kAllVehicleKinds = {VehicleKind::kCar, VehicleKind::kVan,
                                                VehicleKind::kBus};

/// As scenario files call it: car, van, bus.
std::string_view vehicle_name(VehicleKind kind);

/// A vehicle that drives round a route, in the route's direction.
struct VehiclePlan {
  Route route;
  double speed_m_s = 5;  ///< nominal; it slows down in turns
  VehicleKind kind = VehicleKind::kCar;
};

/// The boxes of a vehicle; its frame is on the ground below its middle, x ahead.
std::vector<BodyBox> vehicle_boxes(VehicleKind kind);

/// Length and width of a vehicle in metres.
Eigen::Vector2d vehicle_size(VehicleKind kind);

/// Drives the vehicles one after another, slow ones first; where each starts depends on the seed.
/// Each knows where the robot will go (and where kidnaps will put it), waits, speeds up or backs
/// off where it would come within kVehicleClearance of its axis, and likewise keeps off people and
/// the vehicles before it. A vehicle that finds no such way round from any of the starts that are
/// tried is left out: none ever drives through the robot, or the robot through it.
std::vector<Mover> drive_vehicles(const std::vector<VehiclePlan>& plans, const Drive& robot,
                                  const Walkers& people, std::uint64_t seed);

/// Metres between a vehicle's outline and the axis of the robot.
inline constexpr double kVehicleClearance = 1.0;

}  // namespace holdfast::simulation
