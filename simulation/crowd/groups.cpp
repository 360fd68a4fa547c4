#include "simulation/crowd/groups.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/core/random.hpp"
#include "simulation/events/event_schedule.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kFirst = 4;                 // seconds from the start
constexpr TimeNs kHorizon = 3600 * kSecond;  // no group comes later
constexpr TimeNs kApart = 6 * kSecond;       // from what else happens to the robot
constexpr double kSpread = 0.15;             // metres between the nearest and the farthest

bool is_near(const TimeSpan& span, const EventSpec& event) {
  const bool takes_away = event.kind == EventKind::kKidnap || event.kind == EventKind::kCrowd;
  return takes_away && span.begin < event.start + event.duration + kApart &&
         event.start < span.end + kApart;
}

void add_groups(const GroupPlan& plan, const std::vector<EventSpec>& events, std::uint64_t seed,
                std::vector<CrowdPlan>& crowds) {
  if (plan.people == 0) return;
  RandomStream random(seed, "groups");
  TimeNs t = from_seconds(kFirst);
  while (t < kHorizon) {
    t += from_seconds(-60 / plan.per_minute * std::log(1 - random.uniform()));
    const TimeNs lasts = from_seconds(plan.lasts_s * random.uniform(0.6, 1.4));
    CrowdPlan group{{t, t + lasts}, static_cast<std::size_t>(plan.people), 0};
    group.nearest_m = plan.near_m;
    group.farthest_m = plan.near_m + kSpread;
    group.room_m = plan.near_m;
    t += lasts;
    const bool clashes = std::any_of(events.begin(), events.end(), [&](const EventSpec& event) {
      return is_near(group.span, event);
    });
    if (!clashes) crowds.push_back(group);
  }
}

}  // namespace

std::vector<CrowdPlan> plan_crowds(const std::vector<EventSpec>& events, const GroupPlan& groups,
                                   std::uint64_t seed) {
  std::vector<CrowdPlan> crowds;
  for (const TimeSpan& span : spans_of(EventKind::kCrowd, events)) crowds.push_back({span});
  add_groups(groups, events, seed, crowds);
  return crowds;
}

std::vector<TimeSpan> spans_of(const std::vector<CrowdPlan>& crowds) {
  std::vector<TimeSpan> spans;
  for (const CrowdPlan& crowd : crowds) spans.push_back(crowd.span);
  return spans;
}

}  // namespace holdfast::simulation
