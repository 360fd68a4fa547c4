#pragma once

#include "simulation/scenario.hpp"

/// The scenarios, one source file each.
namespace holdfast::simulation {

Scenario make_box();
Scenario make_corridor();
Scenario make_office();
Scenario make_hall();
Scenario make_warehouse();
Scenario make_yard();
Scenario make_tunnel();
Scenario make_offices();

}  // namespace holdfast::simulation
