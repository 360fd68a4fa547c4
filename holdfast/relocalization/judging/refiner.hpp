#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/registration/correspondences.hpp"
#include "holdfast/registration/levenberg_marquardt.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::relocalization {

/// One resolution of a descent from coarse to fine planes.
struct RefineStage {
  int level;
  float gate_m;
  float surface_sigma_m;  ///< how far a point may still be off its plane
  int iterations;
  bool level_held;  ///< height and tilt: coarse pairs would take a table for the floor
};

/// What is matched, in the body frame.
struct Sight {
  registration::BodyPoints points;
  Eigen::Vector3d gravity_body;  ///< unit vector, downwards
  Eigen::Vector3d p_body_lidar;
  double range_sigma_m = 0.02;
};

/// A pose after matching, in the map frame.
struct Refined {
  SE3 T_map_body;
  registration::NormalEquations equations;  ///< at that pose, of the points alone
  registration::Correspondences pairs;      ///< likewise; only from fully()
  double agreeing_share = 0;                ///< mean robust weight over all points
  bool usable = false;                      ///< enough pairs to have been moved by
};

/// Draws poses onto the planes of a map: Gauss-Newton with robust weights in six degrees of
/// freedom, with what is known of roll and pitch. Keeps its memory from one pose to the next.
class Refiner {
 public:
  /// `map` must be focused near the poses.
  explicit Refiner(const map::PriorMap& map) : map_(map) {}

  /// From the middle of a cell: x, y and yaw by coarse planes, then the height by fine ones.
  Refined roughly(const Sight& sight, const SE3& T_map_body);
  /// From about a decimetre, by the finest planes.
  Refined finely(const Sight& sight, const SE3& T_map_body);
  /// From some centimetres to the end.
  Refined fully(const Sight& sight, const SE3& T_map_body);

  std::uint64_t work() const { return work_; }  ///< points paired since the start

 private:
  Refined descend(const Sight& sight, std::span<const RefineStage> stages, const SE3& T_map_body);
  void choose_height(const Sight& sight, Refined& refined);
  void match(const Sight& sight, const RefineStage& stage, const SE3& T_map_body);
  bool step(const Sight& sight, const SE3& start, bool level_held, SE3& T_map_body);

  const map::PriorMap& map_;
  WorkerPool alone_{1};
  registration::Correspondences pairs_;
  registration::NormalEquations equations_;
  std::vector<registration::NormalEquations> partials_;
  std::uint64_t work_ = 0;
};

}  // namespace holdfast::relocalization
