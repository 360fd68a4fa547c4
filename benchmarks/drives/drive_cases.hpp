#pragma once

#include <string>
#include <vector>

#include "simulation/events/event.hpp"
#include "simulation/simulation_options.hpp"

namespace holdfast::benchmarks {

/// What goes wrong in a drive.
struct DriveCase {
  std::string name;  ///< "nominal", "handheld", "changed", "carried" or its event's
  std::vector<simulation::EventSpec> events;  ///< at most one
  double changed_share = 0;                   ///< of the world's objects since the survey
  simulation::Motion motion = simulation::Motion::kWheels;
};

/// A drive in which nothing goes wrong, one in a person's hands, one in a changed world, and one
/// for each event that the simulator knows: after two fifths of `duration_s`, and for a tenth of
/// it, if it lasts. A robot that is carried away is away for 15 % of it.
std::vector<DriveCase> drive_cases(double duration_s);

}  // namespace holdfast::benchmarks
