#pragma once

#include <Eigen/Core>
#include <optional>

#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {

/// Where a person can stand and walk in a static world, and where nobody sees them. Places of
/// people are points on the ground, metres in the map frame.
class Walkable {
 public:
  /// `world` is used later and must outlive this.
  explicit Walkable(const RayCaster& world) : world_(world) {}

  /// Height of what lies under `p` at most `reach` below; none without.
  std::optional<double> ground_under(const Eigen::Vector3d& p, double reach) const;

  /// Whether a person can walk straight from one place to another, with 0.3 m of room there.
  bool is_free(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Metres from a person at `from` to a wall (what stands upright from the knees to above the
  /// head) in the horizontal `direction` of unit length; none within `reach`.
  std::optional<double> wall_ahead(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                   double reach) const;

  /// Whether nothing of a person at `place` can be seen from `eye`.
  bool is_hidden(const Eigen::Vector3d& place, const Eigen::Vector3d& eye) const;

 private:
  std::optional<double> range(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                              double reach) const;
  bool is_visible(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return world_.is_visible(from.cast<float>(), to.cast<float>());
  }

  const RayCaster& world_;
};

}  // namespace holdfast::simulation
