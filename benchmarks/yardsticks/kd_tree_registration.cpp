#include "benchmarks/yardsticks/kd_tree_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "holdfast/core/point_set.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::size_t kNeighbours = 5;
constexpr std::size_t kLeafSize = 16;  // the fastest of 5, 10, 16 and 25

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSet>,
                                                  PointSet, 3, std::uint32_t>;

/// Points in the order of the leaves of their tree, so that a leaf lies in one place in memory.
std::vector<Eigen::Vector3f> in_order_of_leaves(const std::vector<Eigen::Vector3f>& points) {
  const PointSet set{points};
  const Index index(3, set, {kLeafSize});
  std::vector<Eigen::Vector3f> sorted;
  sorted.reserve(points.size());
  for (const std::uint32_t i : index.vAcc) sorted.push_back(points[i]);
  return sorted;
}

/// b - a as [position, rotation] in the chart of a.
Eigen::Matrix<double, 6, 1> difference(const SE3& a, const SE3& b) {
  Eigen::Matrix<double, 6, 1> d;
  d << b.translation - a.translation, so3::log(a.rotation.conjugate() * b.rotation);
  return d;
}

void move(SE3& pose, const Eigen::Matrix<double, 6, 1>& step) {
  pose.translation += step.head<3>();
  pose.rotation = (pose.rotation * so3::exp(step.tail<3>())).normalized();
}

}  // namespace

struct KdTreeRegistration::Tree {
  explicit Tree(const std::vector<Eigen::Vector3f>& points)
      : set{points}, index(3, set, {kLeafSize}) {}
  PointSet set;
  Index index;
};

KdTreeRegistration::KdTreeRegistration(std::vector<Eigen::Vector3f> points,
                                       const KdTreeOptions& options)
    : options_(options),
      points_(in_order_of_leaves(points)),
      tree_(std::make_unique<Tree>(points_)) {}

KdTreeRegistration::~KdTreeRegistration() = default;

bool KdTreeRegistration::fit(const std::uint32_t* neighbours, Plane& plane) const {
  Eigen::Matrix<float, 3, kNeighbours> p;
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    p.col(static_cast<Eigen::Index>(i)) = points_[neighbours[i]];
  }
  plane.center = p.rowwise().mean();
  p.colwise() -= plane.center;
  const Eigen::Matrix3f spread = p * p.transpose() * (1.0F / kNeighbours);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes;
  axes.computeDirect(spread);
  plane.sigma_sq = std::max(axes.eigenvalues()[0], 0.0F);
  plane.normal = axes.eigenvectors().col(0);
  const float ratio = options_.least_width_ratio;
  if (axes.eigenvalues()[1] < ratio * ratio * plane.sigma_sq) return false;
  return (plane.normal.transpose() * p).cwiseAbs().maxCoeff() <= options_.most_off_plane_m;
}

bool KdTreeRegistration::find_plane(const Eigen::Vector3f& p, Plane& plane) const {
  std::array<std::uint32_t, kNeighbours> neighbours;
  std::array<float, kNeighbours> distances_sq;
  nanoflann::KNNResultSet<float, std::uint32_t> found(kNeighbours);
  found.init(neighbours.data(), distances_sq.data());
  // The search gives up where even the last neighbour would be too far.
  distances_sq.back() = options_.neighbour_radius_m * options_.neighbour_radius_m;
  tree_->index.findNeighbors(found, p.data(), {});
  return found.full() && fit(neighbours.data(), plane);
}

void KdTreeRegistration::pair(const registration::BodyPoints& points, const SE3& T_map_body,
                              const Eigen::Vector3d& p_body_lidar) {
  const Eigen::Matrix3f R = T_map_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_map_body.translation.cast<float>();
  const Eigen::Vector3f lidar = (T_map_body * p_body_lidar).cast<float>();
  const auto square = [](float x) { return x * x; };
  pairs_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& q = points.points[i];
    const Eigen::Vector3f p = R * q + t;
    pairs_.px[i] = q.x();
    pairs_.py[i] = q.y();
    pairs_.pz[i] = q.z();
    pairs_.age_s[i] = points.age_s[i];
    Plane plane;
    const bool paired =
        find_plane(p, plane) && std::abs(plane.normal.dot(p - plane.center)) < options_.gate_m;
    if (!paired) {
      pairs_.nx[i] = pairs_.ny[i] = pairs_.nz[i] = pairs_.offset[i] = pairs_.information[i] = 0;
      continue;
    }
    const Eigen::Vector3f ray = p - lidar;
    const float cosine_sq = square(plane.normal.dot(ray)) / ray.squaredNorm();
    pairs_.nx[i] = plane.normal.x();
    pairs_.ny[i] = plane.normal.y();
    pairs_.nz[i] = plane.normal.z();
    pairs_.offset[i] = plane.normal.dot(plane.center);
    pairs_.information[i] = 1.0F / (square(options_.range_sigma_m) * cosine_sq + plane.sigma_sq +
                                    square(options_.surface_sigma_m));
  }
}

Registration KdTreeRegistration::align(const registration::BodyPoints& points,
                                       const Eigen::Vector3d& p_body_lidar,
                                       const RegistrationStart& start) {
  Registration result{start.T_map_body};
  SE3& pose = result.T_map_body;
  SE3 paired_at;
  while (result.iterations < options_.max_iterations) {
    const auto since = difference(paired_at, pose);
    if (result.searches == 0 || since.head<3>().norm() > options_.repair_m ||
        since.tail<3>().norm() > options_.repair_rad) {
      pair(points, pose, p_body_lidar);
      paired_at = pose;
      ++result.searches;
    }
    const auto e = registration::linearise(pairs_, pose, options_.robust_scale, pool_, partials_);
    const Matrix6d A = e.H.topLeftCorner<6, 6>() + start.information;
    const Eigen::Matrix<double, 6, 1> b =
        e.g.head<6>() + start.information * difference(start.T_map_body, pose);
    const Eigen::Matrix<double, 6, 1> step = -A.ldlt().solve(b);
    result.pairs = e.pairs;
    ++result.iterations;
    if (!step.allFinite()) break;  // no pairs and no prior
    move(pose, step);
    if (step.head<3>().norm() < options_.converged_m &&
        step.tail<3>().norm() < options_.converged_rad) {
      break;
    }
  }
  return result;
}

}  // namespace holdfast::benchmarks
