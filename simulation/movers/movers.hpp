#pragma once

#include <cstdint>
#include <vector>

#include "simulation/motion/trajectory.hpp"
#include "simulation/movers/body_box.hpp"

namespace holdfast::simulation {

/// A rigid thing that moves on its way whatever the robot does: a vehicle, a lift's cabin, a door.
struct Mover {
  Trajectory path;  ///< of its frame in the map; times from the start of the log
  std::vector<BodyBox> boxes;
};

/// Where a ray meets a mover.
struct MoverHit {
  double range = 0;                                      ///< metres
  double cos_incidence = 0;                              ///< 0 (grazing) to 1 (square)
  std::uint16_t material = 0;                            ///< index into World::materials
  Eigen::Vector3d normal_map = Eigen::Vector3d::Zero();  ///< unit, towards where the ray came from
};

/// All that moves in a world but people. Immutable once made; thread-safe.
class Movers {
 public:
  Movers() = default;
  /// Materials that `materials` lacks (by name) are added to it: hits refer to it.
  Movers(std::vector<Mover> movers, std::vector<Material>& materials);

  std::size_t size() const { return movers_.size(); }
  const std::vector<BodyBox>& boxes(std::size_t i) const { return movers_[i].boxes; }
  /// Where mover `i` is at `t` (from the start of the log), and how it moves.
  MotionState at(std::size_t i, TimeNs t) const { return movers_[i].path.at(t); }
  /// Metres about the origin of its frame within which the whole of mover `i` lies.
  double radius(std::size_t i) const { return radius_[i]; }

  /// First point of mover `i` on the ray from `origin` along the unit vector `direction` (map
  /// frame), between the ranges, `since_s` after it was in `state`: it is carried on with its
  /// velocity and turning rate.
  bool meets(std::size_t i, const MotionState& state, double since_s, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction, double min_range, double max_range,
             MoverHit& hit) const;

 private:
  std::vector<Mover> movers_;
  std::vector<double> radius_;
  std::vector<std::vector<std::uint16_t>> material_of_;  ///< [mover][box]
};

}  // namespace holdfast::simulation
