#pragma once

#include <vector>

#include "holdfast/core/fields.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// A lift with a door at either end of its cabin, on the robot's way: where the route goes on
/// higher, at `at`, the cabin takes it there. The world's walls leave openings for the doors,
/// kLandingGap beyond the cabin's ends; there is no shaft.
struct LiftPlan {
  Eigen::Vector2d at{0, 0};  ///< middle of the cabin
  double yaw_deg = 0;        ///< of the way through it; 0 along x
  double length = 2.6;       ///< of the cabin within, along that way
  double width = 2.4;        ///< across
  double height = 2.4;
  double door_width = 1.2;
  double door_height = 2.1;
  std::vector<double> floors;  ///< heights at which it stops
  bool has_at = false, has_floors = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at, FieldDoc{"x y of the middle of its cabin"}, &self.has_at);
    visit("yaw_deg", self.yaw_deg, FieldDoc{"of the way through it; 0 along x"});
    visit("length", self.length, FieldDoc{"of the cabin within, along that way", 1, 20});
    visit("width", self.width, FieldDoc{"likewise across", 1, 20});
    visit("height", self.height, FieldDoc{"likewise", 1, 10});
    visit("door_width", self.door_width, FieldDoc{"of the doors at both ends", 0.6, 20});
    visit("door_height", self.door_height, FieldDoc{"likewise", 1, 10});
    visit("floors", self.floors, FieldDoc{"heights at which it stops"}, &self.has_floors);
  }
};

/// Metres from the end of a cabin to the landing doors, which stand within the building's walls.
inline constexpr double kLandingGap = 0.2;

/// Cabins, their doors and the landing doors, as the robot's rides need them. A cabin stands where
/// the robot will board next; doors are open while it boards and leaves, on that side only. During
/// a ride the cabin moves exactly as the robot does.
std::vector<Mover> run_lifts(const std::vector<LiftPlan>& lifts, const Drive& robot);

/// The world as a surveyor found it, who took the stairs: all landing doors are closed, and no
/// cabin was seen.
World with_closed_doors(const World& world, const std::vector<LiftPlan>& lifts);

}  // namespace holdfast::simulation
