#include "simulation/scenario.hpp"

#include <fmt/format.h>

#include <array>

#include "simulation/files/scenario_file.hpp"
#include "simulation/files/world_file.hpp"
#include "simulation/scenarios/all.hpp"
#include "simulation/scenarios/town.hpp"

namespace holdfast::simulation {
namespace {

constexpr std::array<ScenarioInfo, 12> kScenarios = {{
    {"corridor", "50 x 3 m with doors, pilasters and boards; 100 m there and back", make_corridor},
    {"office", "10 x 8 m with desks, cabinets, five people walking and groups; 200 m of rounds",
     make_office},
    {"hall", "20 x 15 m of glass and polished stone with a lobby, poor in returns; 150 m",
     make_hall},
    {"warehouse", "40 x 24 m with rows of racks that look alike; 200 m", make_warehouse},
    {"yard", "80 x 60 m open ground between buildings, trees and poles; 250 m", make_yard},
    {"tunnel", "200 m of vaulted tube, 9 m wide, with little that tells how far one is; 440 m",
     make_tunnel},
    {"offices", "40 x 25 m floor of rooms round a ring of corridors, seven people; 170 m",
     make_offices},
    {"garage", "40 x 24 m car park of two levels, one as the other, with ramps between; 260 m",
     make_garage},
    {"campus",
     "fire lane, walkway, plaza and street with traffic, six people; 1910 m there and back",
     make_campus},
    {"lift", "40 x 18 m, two floors that look alike and a lift that the robot takes; 300 m",
     make_lift},
    {"town", "0.1 km^2 of streets with traffic, each block another; town:2km2 is larger; 530 m",
     make_town},
    {"box", "empty room of 12 x 8 x 4 m, for tests with closed forms; 30 m", make_box},
}};

}  // namespace

namespace {

/// From the files beside the sources, which were built in.
Scenario from_file(const std::string& name) {
  return *parse_scenario(std::string(scenario_text(name)), name);
}

}  // namespace

Scenario make_box() { return from_file("box.yaml"); }
Scenario make_corridor() { return from_file("corridor.yaml"); }
Scenario make_office() { return from_file("office.yaml"); }
Scenario make_hall() { return from_file("hall.yaml"); }
Scenario make_warehouse() { return from_file("warehouse.yaml"); }
Scenario make_yard() { return from_file("yard.yaml"); }
Scenario make_tunnel() { return from_file("tunnel.yaml"); }
Scenario make_garage() { return from_file("garage.yaml"); }
Scenario make_campus() { return from_file("campus.yaml"); }
Scenario make_lift() { return from_file("lift.yaml"); }

std::span<const ScenarioInfo> scenarios() { return kScenarios; }

Result<Scenario> make_scenario(std::string_view name) {
  if (name.ends_with(".yaml")) return read_scenario_file(name);
  if (name.starts_with("town:")) return make_town(name);
  if (is_world_file(name)) return read_world_file(name);
  std::string known;
  for (const ScenarioInfo& info : kScenarios) {
    if (info.name == name) return info.make();
    known += fmt::format("{}{}", known.empty() ? "" : ", ", info.name);
  }
  return Error{
      fmt::format("unknown scenario '{}'; known are: {}, and files that end in .yaml, "
                  ".pcd, .ply or .obj",
                  name, known)};
}

}  // namespace holdfast::simulation
