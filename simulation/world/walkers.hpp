#pragma once

#include <cstdint>
#include <vector>

#include "simulation/motion/drive.hpp"
#include "simulation/motion/route.hpp"

namespace holdfast::simulation {

/// A person who walks round a route.
struct WalkerPlan {
  Route route;
  double speed_m_s = 0.8;
};

/// A moving solid at one time: all points within `radius` of the segment a-b, moving with
/// `velocity`.
struct Capsule {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius = 0.1;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// The people of a world. They wait for the robot or step back when it comes too close.
class Walkers {
 public:
  Walkers() = default;
  /// Where and how fast each starts depends on the seed.
  Walkers(const std::vector<WalkerPlan>& plans, const Drive& robot, std::uint64_t seed);

  std::size_t size() const { return people_.size(); }
  /// Where person `i` stands on the ground at `t` (from the start of the log).
  Eigen::Vector3d position(std::size_t i, TimeNs t) const;
  /// Head, trunk and legs of all people at `t`: kCapsulesEach capsules a person, in order.
  static constexpr std::size_t kCapsulesEach = 4;
  void shapes_at(TimeNs t, std::vector<Capsule>& shapes) const;

 private:
  struct Person {
    Route route;
    std::vector<double> gone;  ///< metres along the route, control values of a smooth curve in time
    double step_phase = 0;
  };
  std::vector<Person> people_;
};

}  // namespace holdfast::simulation
