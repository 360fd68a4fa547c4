#include <cmath>

#include "simulation/motion/drive_planner.hpp"
#include "simulation/motion/drive_ticks.hpp"

/// The part of DrivePlanner that has the robot carried.
namespace holdfast::simulation {
namespace {

constexpr double kCarryReach = 2.5;  // metres at most for each second of a carry

// To be told how long a carry must last one tries longer and longer ones.
constexpr std::size_t kCarryStep = 5;  // ticks
constexpr std::size_t kCarryMost = 1200;

}  // namespace

/// Carries the robot from where it stands at `tick`, once it stands; false if it does not yet.
bool DrivePlanner::pick_up(const TimeSpan& carry, std::size_t tick) {
  constexpr std::size_t kStill = kMeanReach + kSplineReach;
  const double gone = gone_[tick];
  if (gone_[tick - kStill] != gone) return false;
  const double gone_before = gone_[tick_at(carry.begin)];
  const std::size_t last = tick_at(carry.end);
  const std::size_t begin = tick + kSplineReach;
  const std::size_t ticks = last > begin + kSplineReach ? last - begin - kSplineReach : 0;
  std::size_t needed = ticks;
  auto candidates = carry_candidates(begin, needed, gone_before);
  const bool in_time = !candidates.empty();
  while (candidates.empty() && needed < kCarryMost) {
    needed += kCarryStep;
    candidates = carry_candidates(begin, needed, gone_before);
  }
  const auto reach = static_cast<TimeNs>(needed + kSplineReach + 1);
  needed_for_carries_.push_back(in_time ? 0 : tick_time(begin) + reach * kKnot - carry.begin);
  if (!in_time) return true;
  legs_.push_back(candidates[kidnap_random_.below(candidates.size())]);
  rides_.leave(tick_time(tick));
  legs_.back().lifted = rides_.height(tick_time(tick));
  return true;
}

/// Legs that begin far enough away, from where the robot rests and from where it was when it had
/// gone `gone_before`, and to which a person can carry it in so many ticks from `begin` on.
std::vector<DrivePlanner::Leg> DrivePlanner::carry_candidates(std::size_t begin, std::size_t ticks,
                                                              double gone_before) const {
  std::vector<Leg> out;
  if (ticks == 0) return out;
  constexpr double kStep = 0.25;
  const Leg& from = legs_.back();
  const double gone = gone_.back();
  const double s = from.s + gone - from.gone;
  const Leg before{from.start, from.course, from.s + gone_before - from.gone, gone};
  const Leg here{from.start, from.course, s, gone};
  const int most =
      static_cast<int>(kCarryReach * static_cast<double>(ticks) * kKnotSeconds / kStep);
  for (int i = -most; i <= most; ++i) {
    const double way = i * kStep;
    const Route& route = courses_[from.course].route;
    if (off_lifts(route, s + way) != s + way) continue;
    const double turned_s = route.reversed_s(s + way);
    const TimeNs start = tick_time(begin - kSplineReach);
    for (const Leg& to : {Leg{start, from.course, s + way, gone, begin + ticks, way},
                          Leg{start, 1 - from.course, turned_s, gone, begin + ticks, way}}) {
      if (!is_far(here, to) || !is_far(before, to)) continue;
      const CarryPath path = carry_path(here, to);
      if (is_humanly_possible(carried(path, ticks, kKnot), kKnot)) out.push_back(to);
    }
  }
  return out;
}

CarryPath DrivePlanner::carry_path(const Leg& from, const Leg& to) const {
  CarryPath path{courses_[from.course].route, from.s + to.gone - from.gone, to.carried_m,
                 pose(from, to.gone), pose(to, to.gone)};
  path.to[3] = path.from[3] + std::remainder(path.to[3] - path.from[3], kTwoPi);
  return path;
}

/// Makes leg `leg` begin where the leg before it rests: carried to the place where it goes on.
void DrivePlanner::carry(std::size_t leg, Controls& after) const {
  const Leg& to = legs_[leg];
  const CarryPath path = carry_path(legs_[leg - 1], to);
  const std::size_t begin = tick_at(to.start) + kSplineReach;
  const Controls way = carried(path, to.put_down - begin, kKnot);
  const double turn = path.to[3] - pose(to, to.gone)[3];
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::size_t tick = first_tick(leg) + i;
    after[i][3] += turn;
    if (tick < to.put_down) after[i] = way[tick > begin ? tick - begin : 0];
  }
}

}  // namespace holdfast::simulation
