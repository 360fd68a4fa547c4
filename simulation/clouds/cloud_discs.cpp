#include "simulation/clouds/cloud_discs.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "holdfast/core/point_set.hpp"
#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kNeighbours = 16;  // the point itself included
constexpr std::size_t kFewest = 6;       // of which a plane is fitted
constexpr std::size_t kChunk = 4096;
constexpr double kFlat = 0.1;     // smallest to middle eigenvalue of a plane's points, at most
constexpr double kWide = 0.05;    // middle to largest, at least: else they lie on a line
constexpr double kCleaner = 0.5;  // of its own deviation: a neighbour's plane is taken instead
constexpr double kOnPlane = 2;    // deviations
constexpr double kNear = 1e-3;    // metres that always count as on the plane
constexpr int kPasses = 2;        // the cleanest plane may come from a neighbour's neighbour
constexpr std::size_t kSectors = 6;
constexpr double kReach = 0.7;
constexpr double kLargestDisc = 0.5;  // metres
constexpr double kRimReach = 0.4;
constexpr double kLeafReach = 0.35;
constexpr double kLargestLeaf = 0.1;  // metres
constexpr std::size_t kLeafNeighbours = 4;

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSet>,
                                                 PointSet, 3, std::uint32_t>;

/// The nearest points of a point, itself first.
struct Neighbourhood {
  std::array<std::uint32_t, kNeighbours> index;
  std::uint32_t count = 0;
};

/// The plane of a neighbourhood.
struct Plane {
  Vector3f mean = Vector3f::Zero();
  Vector3f normal = Vector3f::UnitZ();
  float deviation = 0;  ///< root mean square, metres
  bool is_flat = false;

  double distance(const Vector3f& p) const { return std::abs(normal.dot(p - mean)); }
  bool holds(const Vector3f& p) const { return distance(p) <= kOnPlane * deviation + kNear; }
};

/// The first point of each cube, in the order of cubes, which keeps neighbours together.
std::vector<Vector3f> thinned(const std::vector<Vector3f>& points, double spacing) {
  std::vector<std::pair<std::array<std::int32_t, 3>, std::uint32_t>> order;
  order.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<std::int32_t, 3> cube;
    for (int k = 0; k < 3; ++k) {
      cube[k] = static_cast<std::int32_t>(std::floor(points[i][k] / spacing));
    }
    order.emplace_back(cube, static_cast<std::uint32_t>(i));
  }
  std::sort(order.begin(), order.end());
  std::vector<Vector3f> out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && order[i].first == order[i - 1].first) continue;
    out.push_back(points[order[i].second]);
  }
  return out;
}

/// Fits discs to a cloud whose points keep some distance.
class DiscFitter {
 public:
  DiscFitter(const std::vector<Vector3f>& points, WorkerPool& pool)
      : points_(points), pool_(pool), near_(points.size()), planes_(points.size()) {}

  CloudDiscs fit() {
    find_planes();
    for (int pass = 1; pass < kPasses; ++pass) spread_clean_planes();
    std::vector<CloudDiscs> parts(chunk_count(points_.size(), kChunk));
    for_each_chunk(pool_, points_.size(), kChunk,
                   [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                     RandomStream random(1, "cloud.leaves." + std::to_string(chunk));
                     for (std::size_t i = begin; i < end; ++i) add(i, random, parts[chunk]);
                   });
    CloudDiscs out;
    for (const CloudDiscs& part : parts) {
      out.surfaces.insert(out.surfaces.end(), part.surfaces.begin(), part.surfaces.end());
      out.scattered.insert(out.scattered.end(), part.scattered.begin(), part.scattered.end());
    }
    return out;
  }

 private:
  void find_planes() {
    const PointSet set{points_};
    const Tree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    for_each_chunk(
        pool_, points_.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            std::array<float, kNeighbours> distance_sq;
            near_[i].count = static_cast<std::uint32_t>(tree.knnSearch(
                points_[i].data(), kNeighbours, near_[i].index.data(), distance_sq.data()));
            planes_[i] = plane_of(near_[i]);
          }
        });
  }

  /// Each point takes the plane it would choose, so that the next pass looks further.
  void spread_clean_planes() {
    std::vector<Plane> chosen(planes_.size());
    for_each_chunk(pool_, points_.size(), kChunk,
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) chosen[i] = plane_through(i);
                   });
    planes_ = std::move(chosen);
  }

  Plane plane_of(const Neighbourhood& near) const {
    if (near.count < kFewest) return {};
    Vector3d mean = Vector3d::Zero();
    for (std::size_t k = 0; k < near.count; ++k) mean += points_[near.index[k]].cast<double>();
    mean /= near.count;
    Matrix3d spread = Matrix3d::Zero();
    for (std::size_t k = 0; k < near.count; ++k) {
      const Vector3d d = points_[near.index[k]].cast<double>() - mean;
      spread += d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
    solver.computeDirect(spread / near.count);
    const Vector3d& values = solver.eigenvalues();
    const bool is_flat = values[0] < kFlat * values[1] && values[1] > kWide * values[2];
    return {mean.cast<float>(), solver.eigenvectors().col(0).normalized().cast<float>(),
            static_cast<float>(std::sqrt(std::max(0.0, values[0]))), is_flat};
  }

  /// The point's own plane, or that of the neighbour which has the cleanest one through the point.
  const Plane& plane_through(std::size_t i) const {
    const Plane* best = &planes_[i];
    double least = best->is_flat ? kCleaner * best->deviation - 1e-4 : 1e9;
    for (std::size_t k = 1; k < near_[i].count; ++k) {
      const Plane& other = planes_[near_[i].index[k]];
      if (!other.is_flat || other.deviation >= least || !other.holds(points_[i])) continue;
      best = &other;
      least = other.deviation;
    }
    return *best;
  }

  void add(std::size_t i, RandomStream& random, CloudDiscs& out) const {
    // Drawn for each point, so that one point does not turn the leaves of the others.
    const Vector3d drawn(random.normal(), random.normal(), random.normal());
    const Plane& plane = plane_through(i);
    const Vector3f& p = points_[i];
    if (plane.is_flat && plane.holds(p)) {
      const Vector3f center = p - plane.normal.dot(p - plane.mean) * plane.normal;
      out.surfaces.push_back({center, radius_in(plane, i), plane.normal, 0});
    } else {
      out.scattered.push_back({p, leaf_radius(i), drawn.normalized().cast<float>(), 0});
    }
  }

  float radius_in(const Plane& plane, std::size_t i) const {
    const Vector3f u = plane.normal.unitOrthogonal();
    const Vector3f v = plane.normal.cross(u);
    std::array<double, kSectors> nearest;
    nearest.fill(-1);
    for (std::size_t k = 1; k < near_[i].count; ++k) {
      const Vector3f& q = points_[near_[i].index[k]];
      if (!plane.holds(q)) continue;
      const double x = u.dot(q - points_[i]);
      const double y = v.dot(q - points_[i]);
      const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
      double& there = nearest[std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors))];
      const double distance = std::hypot(x, y);
      if (there < 0 || distance < there) there = distance;
    }
    return static_cast<float>(radius_of(nearest));
  }

  static double radius_of(std::array<double, kSectors> nearest) {
    bool rim = false;
    for (std::size_t k = 0; k < kSectors; ++k) {
      rim = rim || (nearest[k] < 0 && nearest[(k + 1) % kSectors] < 0);
    }
    std::sort(nearest.begin(), nearest.end());
    const auto filled =
        std::find_if(nearest.begin(), nearest.end(), [](double d) { return d >= 0; });
    if (filled == nearest.end()) return kNear;
    const double radius =
        rim ? kRimReach * *(filled + (nearest.end() - filled) / 2) : kReach * nearest.back();
    return std::min(kLargestDisc, radius);
  }

  float leaf_radius(std::size_t i) const {
    double sum = 0;
    const std::size_t last = std::min<std::size_t>(near_[i].count, kLeafNeighbours + 1);
    for (std::size_t k = 1; k < last; ++k) sum += (points_[near_[i].index[k]] - points_[i]).norm();
    const double mean = last > 1 ? sum / static_cast<double>(last - 1) : kLargestLeaf;
    return static_cast<float>(std::min(kLargestLeaf, kLeafReach * mean));
  }

  const std::vector<Vector3f>& points_;
  WorkerPool& pool_;
  std::vector<Neighbourhood> near_;
  std::vector<Plane> planes_;
};

}  // namespace

CloudDiscs discs_of(const std::vector<Vector3f>& points, double spacing_m, WorkerPool& pool) {
  const std::vector<Vector3f> apart = thinned(points, spacing_m);
  if (apart.empty()) return {};
  return DiscFitter(apart, pool).fit();
}

}  // namespace holdfast::simulation
