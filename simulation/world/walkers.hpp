#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/motion/trajectory.hpp"
#include "simulation/world/capsule.hpp"

namespace holdfast::simulation {

/// A person who walks round a route.
struct WalkerPlan {
  Route route;
  double speed_m_s = 0.8;
};

/// Someone who is there for some time only.
struct Passer {
  Trajectory path;  ///< over the ground
  TimeSpan present;
  double step_phase = 0;
};

/// The people of a world. Each keeps to a route, and waits or steps back where the robot would come
/// too close.
class Walkers {
 public:
  Walkers() = default;
  /// Where each starts and which way it goes depends on the seed.
  Walkers(const std::vector<WalkerPlan>& plans, const Drive& robot, std::uint64_t seed);

  /// Adds people after those who are there.
  void join(const std::vector<Passer>& passers);

  std::size_t size() const { return people_.size(); }
  bool is_there(std::size_t i, TimeNs t) const {
    return !people_[i].present || people_[i].present->contains(t);
  }
  /// Where person `i` is on the ground at `t` (from the start of the log), and how it moves.
  MotionState at(std::size_t i, TimeNs t) const;
  /// Trunk, head and two swinging legs of all people who are there at `t`: kCapsulesEach a person,
  /// in order.
  static constexpr std::size_t kCapsulesEach = 4;
  void shapes_at(TimeNs t, std::vector<Capsule>& shapes) const;

 private:
  struct Person {
    Trajectory path;
    double step_phase;
    std::optional<TimeSpan> present;  ///< none: all the time
  };
  std::vector<Person> people_;
};

}  // namespace holdfast::simulation
