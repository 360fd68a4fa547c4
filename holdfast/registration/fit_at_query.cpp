#include "holdfast/registration/fit_at_query.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <optional>

#include "holdfast/core/point_set.hpp"
#include "holdfast/registration/levenberg_marquardt.hpp"

namespace holdfast::registration {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kMostNeighbours = 64;
constexpr double kMostOffPlaneM = 0.2;    // of a neighbour (LIO-SAM)
constexpr double kMostOffLineM = 0.1;     // of a neighbour that belongs to a boundary line
constexpr double kLeastElongation = 3.0;  // of a line: eigenvalue along against that across (LOAM)
constexpr double kSettledM = 1e-3;        // motion below which no new search is made
constexpr double kSettledRad = 1e-4;

/// Points of one kind with their tree.
struct Cloud {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSet>,
                                                    PointSet, 3, std::uint32_t>;
  explicit Cloud(std::vector<Vector3f> its_points)
      : points(std::move(its_points)),
        set{points},
        index(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  std::vector<Vector3f> points;
  PointSet set;
  Index index;
};

/// The nearest points of a cloud within a radius, the nearest first.
struct Neighbours {
  std::array<Vector3d, kMostNeighbours> points;
  std::size_t count = 0;

  Neighbours(const Cloud& cloud, const Vector3d& p, double radius, int most) {
    std::array<std::uint32_t, kMostNeighbours> index;
    std::array<float, kMostNeighbours> distance_sq;
    nanoflann::KNNResultSet<float, std::uint32_t> found(static_cast<std::size_t>(most));
    found.init(index.data(), distance_sq.data());
    // The search gives up where even the last neighbour would be too far.
    distance_sq[static_cast<std::size_t>(most) - 1] = static_cast<float>(radius * radius);
    const Vector3f query = p.cast<float>();
    if (!cloud.points.empty()) cloud.index.findNeighbors(found, query.data(), {});
    count = found.size();
    for (std::size_t i = 0; i < count; ++i) points[i] = cloud.points[index[i]].cast<double>();
  }
};

/// Centroid and principal axes, eigenvalues ascending.
struct Principal {
  Vector3d mean;
  Vector3d values;
  Matrix3d axes;
};

Principal principal_of(const Vector3d* points, std::size_t n) {
  Vector3d mean = Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) mean += points[i];
  mean /= static_cast<double>(n);
  Matrix3d covariance = Matrix3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    covariance += (points[i] - mean) * (points[i] - mean).transpose();
  }
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(covariance / static_cast<double>(n));
  return {mean, solver.eigenvalues(), solver.eigenvectors()};
}

struct Line {
  Vector3d point, direction;
  double distance(const Vector3d& p) const { return (p - point).cross(direction).norm(); }
};

struct Plane {
  Vector3d normal;
  double offset;
};

/// The line through the first of `points` and the one that most others lie on with it. Its points
/// are taken out of `points`.
std::optional<Line> take_line(std::array<Vector3d, kMostNeighbours>& points, std::size_t& count,
                              std::size_t least) {
  if (count < least) return std::nullopt;
  std::size_t best = 0, most = 0;
  const auto on_line = [&](std::size_t second, std::size_t i) {
    const Vector3d d = (points[second] - points[0]).normalized();
    return (points[i] - points[0]).cross(d).norm() < kMostOffLineM;
  };
  for (std::size_t second = 1; second < count; ++second) {
    if ((points[second] - points[0]).norm() < kMostOffLineM) continue;
    std::size_t members = 0;
    for (std::size_t i = 0; i < count; ++i) members += on_line(second, i);
    if (members <= most) continue;
    most = members;
    best = second;
  }
  if (most < least) return std::nullopt;
  std::array<Vector3d, kMostNeighbours> members;
  std::size_t n = 0, left = 0;
  std::array<bool, kMostNeighbours> on{};
  for (std::size_t i = 0; i < count; ++i) on[i] = on_line(best, i);
  for (std::size_t i = 0; i < count; ++i) (on[i] ? members[n++] : points[left++]) = points[i];
  count = left;
  const Principal p = principal_of(members.data(), n);
  if (p.values[2] < kLeastElongation * p.values[1]) return std::nullopt;
  return Line{p.mean, p.axes.col(2)};
}

/// Article 3.2.2 (1).
std::optional<Line> nearest_line(const Cloud& edges, const Vector3d& p,
                                 const FitAtQueryConfig& config) {
  Neighbours near(edges, p, config.edge_radius_m, config.edge_neighbours);
  const auto least = static_cast<std::size_t>(config.line_points);
  const auto first = take_line(near.points, near.count, least);
  const auto second = take_line(near.points, near.count, least);
  if (!first || !second) return first ? first : second;
  return first->distance(p) <= second->distance(p) ? first : second;
}

/// Article 3.2.2 (2).
std::optional<Plane> fitted_plane(const Cloud& planes, const Vector3d& p,
                                  const FitAtQueryConfig& config) {
  const Neighbours near(planes, p, config.plane_radius_m, config.plane_neighbours);
  if (near.count < static_cast<std::size_t>(config.plane_points)) return std::nullopt;
  const Principal axes = principal_of(near.points.data(), near.count);
  const Plane plane{axes.axes.col(0), axes.axes.col(0).dot(axes.mean)};
  for (std::size_t i = 0; i < near.count; ++i) {
    if (std::abs(plane.normal.dot(near.points[i]) - plane.offset) > kMostOffPlaneM)
      return std::nullopt;
  }
  return plane;
}

/// Points of a scan with their lines and planes.
struct Matches {
  std::vector<std::pair<Vector3d, Line>> edges;
  std::vector<std::pair<Vector3d, Plane>> planes;

  bool valid(const FitAtQueryConfig& config) const {
    return edges.size() >= static_cast<std::size_t>(config.least_edges) &&
           planes.size() >= static_cast<std::size_t>(config.least_planes);
  }
};

/// (R e + t - l0) x d: the derivative by t is -[d]x, by the rotation [d]x R [e]x.
void add_edge(const Vector3d& e, const Line& line, const SE3& T, const Matrix3d& R, double weight,
              PoseModel& model) {
  const Vector3d r = (T * e - line.point).cross(line.direction);
  Eigen::Matrix<double, 3, 6> J;
  J.leftCols<3>() = -so3::hat(line.direction);
  J.rightCols<3>() = so3::hat(line.direction) * R * so3::hat(e);
  for (int row = 0; row < 3; ++row) model.add(r[row], J.row(row).transpose(), weight);
}

PoseModel model_of(const Matches& matches, const FitAtQueryConfig& config, const SE3& T) {
  PoseModel model;
  const Matrix3d R = T.rotation.toRotationMatrix();
  for (const auto& [e, line] : matches.edges) add_edge(e, line, T, R, config.edge_weight, model);
  for (const auto& [f, plane] : matches.planes) {
    Vector6d J;
    J << plane.normal, f.cross(R.transpose() * plane.normal);
    model.add(plane.normal.dot(T * f) - plane.offset, J, config.plane_weight);
  }
  return model;
}

void summarise(const Matches& matches, FitAtQueryResult& result) {
  result.edges = static_cast<int>(matches.edges.size());
  result.planes = static_cast<int>(matches.planes.size());
  result.mean_abs_edge_m = result.mean_abs_plane_m = 0;
  for (const auto& [e, line] : matches.edges) {
    result.mean_abs_edge_m += line.distance(result.T_map_body * e) / result.edges;
  }
  for (const auto& [f, plane] : matches.planes) {
    result.mean_abs_plane_m +=
        std::abs(plane.normal.dot(result.T_map_body * f) - plane.offset) / result.planes;
  }
}

}  // namespace

struct FitAtQuery::Trees {
  Cloud edges, planes;

  Matches match(const FeatureClouds& scan, const SE3& T, const FitAtQueryConfig& config) const {
    Matches matches;
    for (const Vector3f& e : scan.edges) {
      const auto line = nearest_line(edges, T * e.cast<double>(), config);
      if (line) matches.edges.emplace_back(e.cast<double>(), *line);
    }
    for (const Vector3f& f : scan.planes) {
      const auto plane = fitted_plane(planes, T * f.cast<double>(), config);
      if (plane) matches.planes.emplace_back(f.cast<double>(), *plane);
    }
    return matches;
  }
};

FitAtQuery::FitAtQuery(FeatureClouds map, const FitAtQueryConfig& config)
    : config_(config),
      trees_(new Trees{Cloud(std::move(map.edges)), Cloud(std::move(map.planes))}) {}

FitAtQuery::~FitAtQuery() = default;
FitAtQuery::FitAtQuery(FitAtQuery&&) noexcept = default;
FitAtQuery& FitAtQuery::operator=(FitAtQuery&&) noexcept = default;

FitAtQueryResult FitAtQuery::align(const FeatureClouds& scan, const SE3& T_map_body) const {
  FitAtQueryResult result;
  result.T_map_body = T_map_body;
  Matches matches;
  while (result.searches < config_.max_searches && !result.converged) {
    matches = trees_->match(scan, result.T_map_body, config_);
    ++result.searches;
    result.valid = matches.valid(config_);
    if (!result.valid) break;
    const auto found = minimise_by_levenberg_marquardt(
        result.T_map_body, [&](const SE3& T) { return model_of(matches, config_, T); });
    const double step_m = (found.pose.translation - result.T_map_body.translation).norm();
    const double step_rad = so3::angle_between(found.pose.rotation, result.T_map_body.rotation);
    result.T_map_body = found.pose;
    result.converged = step_m < kSettledM && step_rad < kSettledRad;
  }
  if (!result.valid) result.T_map_body = T_map_body;
  summarise(matches, result);
  return result;
}

}  // namespace holdfast::registration
