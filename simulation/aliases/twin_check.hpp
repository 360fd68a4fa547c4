#pragma once

#include "simulation/aliases/range_image.hpp"

namespace holdfast::simulation {

/// Says whether a scan at another pose would look the same as at a given one.
class TwinCheck {
 public:
  /// All are used later. `sigma_m` is the noise of a range.
  TwinCheck(const World& world, const RayCaster& caster, const ImageRays& rays, double sigma_m)
      : world_(world), caster_(caster), rays_(rays), sigma_m_(sigma_m) {}

  /// Moves and turns `T_map_image` about the vertical (Gauss-Newton on the ranges, with weights
  /// that narrow from half a metre to the noise) until it sees what `seen` shows, as far as it can.
  SE3 refined(const RangeImage& seen, const SE3& T_map_image) const;

  /// Rays by which the image from a pose differs from `seen` by more than 4 sigma. A ray that goes
  /// past an edge may take the range of a neighbour: which of the two it meets hangs on less than
  /// its width.
  std::size_t differing(const RangeImage& seen, const SE3& T_map_image) const;

  /// As many as noise explains: the expected number of rays beyond 4 sigma, and 4 deviations.
  std::size_t explained_by_noise() const;

 private:
  struct Step {
    Eigen::Vector4d motion = Eigen::Vector4d::Zero();  ///< x y z in the map, yaw
  };
  Step step(const RangeImage& seen, const SE3& T_map_image, double scale) const;
  std::size_t outside(const std::vector<float>& range, const std::vector<float>& other) const;

  const World& world_;
  const RayCaster& caster_;
  const ImageRays& rays_;
  double sigma_m_;
};

}  // namespace holdfast::simulation
