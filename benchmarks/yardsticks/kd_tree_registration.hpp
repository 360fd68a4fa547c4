#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::benchmarks {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The defaults are those of map_filter wherever it has the same choice.
struct KdTreeOptions {
  float neighbour_radius_m = 0.5F;  ///< five neighbours within it, or the point has no plane
  float most_off_plane_m = 0.1F;    ///< a neighbour farther off the fitted plane: no plane
  float least_width_ratio = 3.0F;   ///< width of the five points against their thickness
  float gate_m = 0.3F;              ///< a point farther from its plane is no correspondence
  float range_sigma_m = 0.02F;
  float surface_sigma_m = 0.004F;
  double robust_scale = 3.0;
  int max_iterations = 6;
  double converged_m = 1e-4, converged_rad = 1e-5;  ///< steps below end the iteration
  double repair_m = 0.02, repair_rad = 0.002;       ///< motion that asks for new neighbours
};

/// Where a registration begins, and how firmly.
struct RegistrationStart {
  SE3 T_map_body;
  /// Information of its [position (map frame), rotation (right perturbation)]; zero: none.
  Matrix6d information = Matrix6d::Zero();
};

struct Registration {
  SE3 T_map_body;
  int iterations = 0;  ///< Gauss-Newton steps
  int searches = 0;    ///< times that the neighbours of all points were searched
  double pairs = 0;    ///< at the last step
};

/// The yardstick of the literature: a scan is registered to the points of the map, with the five
/// nearest neighbours of each point from a k-d tree (nanoflann), a plane fitted to them by their
/// principal axes at query time, and Gauss-Newton on point-to-plane distances. Weights, robust
/// loss, stopping rule, number of points and the prior are those of map_filter, so that what
/// differs is how a plane is found. The tree is built once, over points in the order of its leaves;
/// a query allocates nothing. Single thread.
class KdTreeRegistration {
 public:
  /// `points` in the map frame, metres.
  explicit KdTreeRegistration(std::vector<Eigen::Vector3f> points,
                              const KdTreeOptions& options = {});
  ~KdTreeRegistration();
  KdTreeRegistration(const KdTreeRegistration&) = delete;
  KdTreeRegistration& operator=(const KdTreeRegistration&) = delete;

  /// `points` deskewed, in the body frame; `p_body_lidar` is where their rays begin.
  Registration align(const registration::BodyPoints& points, const Eigen::Vector3d& p_body_lidar,
                     const RegistrationStart& start);

 private:
  struct Tree;
  struct Plane {
    Eigen::Vector3f center, normal;
    float sigma_sq;  ///< mean squared distance of the neighbours
  };

  bool fit(const std::uint32_t* neighbours, Plane& plane) const;
  bool find_plane(const Eigen::Vector3f& p, Plane& plane) const;
  void pair(const registration::BodyPoints& points, const SE3& T_map_body,
            const Eigen::Vector3d& p_body_lidar);

  KdTreeOptions options_;
  std::vector<Eigen::Vector3f> points_;
  std::unique_ptr<Tree> tree_;
  WorkerPool pool_;  ///< of one thread
  registration::Correspondences pairs_;
  std::vector<registration::NormalEquations> partials_;
};

}  // namespace holdfast::benchmarks
