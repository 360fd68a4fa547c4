#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/crowd/groups.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/movers/lifts.hpp"
#include "simulation/movers/vehicles.hpp"
#include "simulation/world/walkers.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// A stretch of a scenario's way by its name: a rectangle over the ground, in the map frame.
struct Region {
  std::string name;
  Eigen::Vector2d min{0, 0};
  Eigen::Vector2d max{1, 1};
  bool has_name = false, has_min = false, has_max = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("name", self.name, FieldDoc{"what it is called"}, &self.has_name);
    visit("min", self.min, FieldDoc{"corner x y"}, &self.has_min);
    visit("max", self.max, FieldDoc{"opposite corner"}, &self.has_max);
  }
};

/// A world, the way a robot takes through it, and who else walks and drives there. One file each in
/// simulation/scenarios; a new one is declared in scenario.cpp.
struct Scenario {
  std::string name;
  World world;
  Route route;
  DriveStyle style;
  std::vector<WalkerPlan> walkers;
  GroupPlan groups;
  std::vector<VehiclePlan> vehicles;
  std::vector<LiftPlan> lifts;
  std::vector<Region> regions;  ///< for results of parts of the way; may be none
  std::string remark;           ///< for the user, about a way that was found; empty: none
};

/// An entry of the list of scenarios.
struct ScenarioInfo {
  std::string_view name;
  std::string_view summary;  ///< one line
  Scenario (*make)();
};

/// All scenarios, in the order in which `holdfast simulate --list` shows them.
std::span<const ScenarioInfo> scenarios();

/// Builds a scenario of that name, or the one in a file whose name ends in .yaml, or drives through
/// a cloud or mesh whose name ends in .pcd, .ply or .obj. The error lists the known names.
Result<Scenario> make_scenario(std::string_view name);

}  // namespace holdfast::simulation
