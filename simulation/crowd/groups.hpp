#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "simulation/crowd/crowd.hpp"
#include "simulation/events/event.hpp"

namespace holdfast::simulation {

/// People who now and then stand close to the robot or walk with it for a while.
struct GroupPlan {
  int people = 0;         ///< a group; 0: there are none
  double per_minute = 1;  ///< groups, of the time between them
  double lasts_s = 10;    ///< on average, coming and going included
  double near_m = 0.8;    ///< from the robot's axis

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("people", self.people, FieldDoc{"of a group; 0: there are none", 0, 12});
    visit("per_minute", self.per_minute, FieldDoc{"of the time between two groups", 0.01, 20});
    visit(
        "lasts_s", self.lasts_s,
        FieldDoc{"on average, from 0.6 to 1.4 times that; a quarter is coming, one going", 3, 100});
    visit("near_m", self.near_m,
          FieldDoc{"how near they come to the robot's axis, where there is room", 0.7, 3});
  }
};

/// All who come to the robot in a drive: the crowds among its `events`, in order of time, and then
/// its groups; when these come depends on the seed. While a crowd is with the robot, or it is
/// kidnapped, no group is.
std::vector<CrowdPlan> plan_crowds(const std::vector<EventSpec>& events, const GroupPlan& groups,
                                   std::uint64_t seed);

/// When any of the crowds is with the robot.
std::vector<TimeSpan> spans_of(const std::vector<CrowdPlan>& crowds);

}  // namespace holdfast::simulation
