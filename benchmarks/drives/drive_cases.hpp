#pragma once

#include <string>
#include <vector>

#include "simulation/events/event.hpp"

namespace holdfast::benchmarks {

/// What goes wrong in a drive.
struct DriveCase {
  std::string name;                           ///< "nominal", "changed", or that of its event
  std::vector<simulation::EventSpec> events;  ///< at most one
  double changed_share = 0;                   ///< of the world's objects since the survey
};

/// A drive in which nothing goes wrong, one in a changed world, and one for each event that the
/// simulator knows: after two fifths of `duration_s`, and for a tenth of it, if it lasts.
std::vector<DriveCase> drive_cases(double duration_s);

}  // namespace holdfast::benchmarks
