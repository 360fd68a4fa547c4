#include "holdfast/map/fitting/surface_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

namespace holdfast::map {
namespace {

/// Sums of a set of points, relative to `base` so that nothing cancels.
struct Moments {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& d) {
    ++count;
    sum += d;
    outer.noalias() += d * d.transpose();
  }
};

/// Centroid and principal axes; eigenvalues ascending, in m^2.
struct Principal {
  Eigen::Vector3d centroid;
  Eigen::Vector3d values;
  Eigen::Matrix3d axes;
};

Principal principal_of(const Moments& m) {
  const Eigen::Vector3d mean = m.sum / m.count;
  const Eigen::Matrix3d covariance = m.outer / m.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return {mean, solver.eigenvalues().cwiseMax(0.0), solver.eigenvectors()};
}

struct Plane {
  Eigen::Vector3d point;  ///< relative to the neighbourhood's centre
  Eigen::Vector3d normal;
  double sigma_m;
  double spread_m;  ///< RMS extent along the shorter of its two axes
  int support;
  double density = 1.0;  ///< support is multiplied by this for Surface::support
};

using Offsets = std::vector<Eigen::Vector3d>;

std::optional<Plane> plane_through(const Moments& m, int min_support) {
  if (m.count < min_support) return std::nullopt;
  const Principal p = principal_of(m);
  // n - 3 degrees of freedom are left after a plane is fitted.
  const double unbias = static_cast<double>(m.count) / std::max(m.count - 3, 1);
  return Plane{p.centroid, p.axes.col(0), std::sqrt(p.values[0] * unbias), std::sqrt(p.values[1]),
               m.count};
}

Moments near_plane(const Offsets& points, const Plane& plane, double band_m) {
  Moments m;
  for (const auto& d : points) {
    if (std::abs(plane.normal.dot(d - plane.point)) < band_m) m.add(d);
  }
  return m;
}

/// The plane of all points, then of those within 3 sigma of it.
std::optional<Plane> robust_plane(const Offsets& points, const FitOptions& options) {
  Moments all;
  for (const auto& d : points) all.add(d);
  const auto first = plane_through(all, options.min_support);
  if (!first) return first;
  const double band = 3.0 * std::max(first->sigma_m, options.noise_m);
  return plane_through(near_plane(points, *first, band), options.min_support);
}

/// A plane is believed where its thickness is explained by the map's noise and is small against its
/// extent.
bool is_flat(const Plane& plane, const FitOptions& options) {
  return plane.sigma_m < 2.0 * options.noise_m && plane.spread_m > 5.0 * plane.sigma_m;
}

Offsets within(const Offsets& points, double radius) {
  Offsets near;
  for (const auto& d : points) {
    if (d.squaredNorm() < radius * radius) near.push_back(d);
  }
  return near;
}

/// The points of a cell and of its neighbourhood, relative to the centroid of the cell's.
struct Neighbourhood {
  Eigen::Vector3d center;
  Offsets own;  ///< in the cell or just outside: what a noisy point in the cell may belong to
  Offsets all;  ///< within the wide radius, thinned out where they are dense
  double density = 1.0;  ///< points there are for each one in `all`
};

constexpr std::size_t kPointsPerCell = 24;  // more in one cell tell nothing new
constexpr double kOwnMargin = 0.2;          // around a cell, as a share of its side

Neighbourhood gather(const PointGrid& grid, const Cell& cell, const FitOptions& options) {
  Neighbourhood n;
  const auto own = grid.points(cell);
  n.center.setZero();
  for (const auto& p : own) n.center += p.cast<double>();
  n.center /= static_cast<double>(own.size());
  const Eigen::Vector3d middle = (cell.cast<double>().array() + 0.5) * grid.cell_m();
  const double own_reach = (0.5 + kOwnMargin) * grid.cell_m();
  const double radius = options.wide_radius * grid.cell_m();
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  const Cell low = grid.cell_of((n.center - reach).cast<float>());
  const Cell high = grid.cell_of((n.center + reach).cast<float>());
  double there = 0;
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const auto points = grid.points({x, y, z});
        const std::size_t step = points.size() / kPointsPerCell + 1;
        for (std::size_t i = 0; i < points.size(); i += step) {
          const Eigen::Vector3d p = points.first[i].cast<double>();
          const Eigen::Vector3d d = p - n.center;
          if (d.squaredNorm() >= radius * radius) continue;
          n.all.push_back(d);
          if (((p - middle).array().abs() < own_reach).all()) n.own.push_back(d);
          there += static_cast<double>(step);
        }
      }
    }
  }
  if (!n.all.empty()) n.density = there / static_cast<double>(n.all.size());
  return n;
}

std::uint16_t saturated(double support) {
  return static_cast<std::uint16_t>(std::clamp(support, 1.0, 65535.0));
}

Surface surface_of(const Plane& plane, const Eigen::Vector3d& center) {
  // The centre lies on the plane at the foot of the perpendicular from the cell's centroid.
  const Eigen::Vector3d foot = plane.normal * plane.normal.dot(plane.point);
  return {(center + foot).cast<float>(),
          plane.normal.cast<float>(),
          static_cast<float>(plane.sigma_m),
          saturated(plane.support * plane.density),
          SurfaceKind::kPlane,
          0};
}

/// The widest neighbourhood that is one plane.
std::optional<Plane> single_plane(const Neighbourhood& n, double cell_m,
                                  const FitOptions& options) {
  auto wide = robust_plane(n.all, options);
  if (!wide) return std::nullopt;
  auto narrow = robust_plane(within(n.all, options.narrow_radius * cell_m), options);
  wide->density = n.density / (options.wide_radius * options.wide_radius);
  if (narrow) narrow->density = n.density / (options.narrow_radius * options.narrow_radius);
  if (!narrow) return is_flat(*wide, options) ? wide : std::nullopt;
  const bool wide_is_as_flat = is_flat(*wide, options) &&
                               4 * wide->support > 3 * static_cast<int>(n.all.size()) &&
                               wide->sigma_m < 1.2 * narrow->sigma_m + 0.1 * options.noise_m;
  if (wide_is_as_flat) return wide;
  if (is_flat(*narrow, options) && narrow->support > static_cast<int>(n.own.size())) return narrow;
  return std::nullopt;
}

/// Does the plane explain the cell's own points, but for stray ones?
bool explains(const Plane& plane, const Offsets& own, const FitOptions& options) {
  constexpr double kShare = 0.85;
  const Moments m = near_plane(own, plane, 3.0 * options.noise_m);
  return m.count >= kShare * static_cast<double>(own.size());
}

/// At most `most` of the points, evenly.
Offsets sample(const Offsets& points, std::size_t most) {
  if (points.size() <= most) return points;
  Offsets few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(points[i * points.size() / most]);
  return few;
}

int count_near(const Offsets& points, const Plane& plane, double band_m) {
  int count = 0;
  for (const auto& d : points)
    count += std::abs(plane.normal.dot(d - plane.point)) < band_m ? 1 : 0;
  return count;
}

/// The plane through three points, two of them the cell's own, that has most points near it; a
/// fixed set of triples, so that the same map always gives the same fits.
std::optional<Plane> best_of_triples(const Offsets& own, const Offsets& all,
                                     const FitOptions& options) {
  constexpr int kTriples = 20;
  const auto n = own.size();
  const Offsets judges = sample(all, 60);
  std::optional<Plane> best;
  for (int k = 0; k < kTriples; ++k) {
    const Eigen::Vector3d& a = own[(k * 7 + 1) % n];
    const Eigen::Vector3d& b = all[(k * 31 + 5) % all.size()];
    const Eigen::Vector3d& c = own[(k * 13 + n / 2) % n];
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    if (cross.norm() < 20.0 * options.noise_m * options.noise_m) continue;
    const Plane candidate{a, cross.normalized(), 0, 0, 0};
    const int near = count_near(judges, candidate, 2.5 * options.noise_m);
    if (best && near <= best->support) continue;
    best = candidate;
    best->support = near;
  }
  return best;
}

void remove_near(Offsets& points, const Plane& plane, double band_m) {
  std::erase_if(points, [&](const Eigen::Vector3d& d) {
    return std::abs(plane.normal.dot(d - plane.point)) < band_m;
  });
}

// A plane with less of the support of a parallel one in its cell is a ghost of it: a wall smeared
// by the poses that the map was made with.
constexpr double kGhostShare = 0.35;
constexpr double kParallel = 0.9;  // cosine between normals

bool is_ghost_of_any(const Plane& plane, const std::vector<Plane>& stronger) {
  return std::any_of(stronger.begin(), stronger.end(), [&](const Plane& other) {
    return plane.support < kGhostShare * other.support &&
           std::abs(plane.normal.dot(other.normal)) > kParallel;
  });
}

/// Leaves out the planes that live on the points of stronger ones: ghosts, and planes across an
/// edge, which hold a strip of each of its sides.
std::vector<Plane> that_stand_alone(std::vector<Plane> planes, Offsets points,
                                    const FitOptions& options) {
  constexpr double kOwnShare = 0.5;
  std::stable_sort(planes.begin(), planes.end(),
                   [](const Plane& a, const Plane& b) { return a.support > b.support; });
  std::vector<Plane> kept;
  for (const Plane& plane : planes) {
    const int own = count_near(points, plane, 3.0 * options.noise_m);
    if (is_ghost_of_any(plane, kept) || own < kOwnShare * plane.support) continue;
    remove_near(points, plane, 3.5 * options.noise_m);
    kept.push_back(plane);
  }
  return kept;
}

/// The plane of the points near a plane, until these are the same.
std::optional<Plane> settled_plane(const Plane& seed, const Offsets& points,
                                   const FitOptions& options) {
  constexpr int kMostFits = 6;
  std::optional<Plane> plane = seed;
  for (int fit = 0; fit < kMostFits; ++fit) {
    const auto next =
        plane_through(near_plane(points, *plane, 3.0 * options.noise_m), options.min_support);
    const bool settled = next && next->support == plane->support && fit > 0;
    plane = next;
    if (!plane || settled) break;
  }
  return plane;
}

/// Edges, corners and thin walls: planes one after the other, each from the points that the ones
/// before left over.
void several_planes(const Neighbourhood& n, double cell_m, const FitOptions& options,
                    std::vector<Surface>& out) {
  constexpr int kMostPlanes = 3;
  const double radius = 1.4 * options.narrow_radius;
  const Offsets whole = within(n.all, radius * cell_m);
  Offsets own = n.own;
  Offsets all = whole;
  std::vector<Plane> planes;
  for (int k = 0;
       k < kMostPlanes && own.size() >= 3 && static_cast<int>(all.size()) >= options.min_support;
       ++k) {
    const auto seed = best_of_triples(own, all, options);
    if (!seed) break;
    auto plane = settled_plane(*seed, all, options);
    if (!plane || !is_flat(*plane, options)) break;
    if (near_plane(own, *plane, 3.0 * options.noise_m).count < 3) break;
    plane->density = n.density / (radius * radius);
    planes.push_back(*plane);
    remove_near(own, *plane, 3.5 * options.noise_m);
    remove_near(all, *plane, 3.5 * options.noise_m);
  }
  for (const Plane& plane : that_stand_alone(std::move(planes), whole, options)) {
    out.push_back(surface_of(plane, n.center));
  }
}

void line_through(const Neighbourhood& n, double cell_m, const FitOptions& options,
                  std::vector<Surface>& out) {
  Moments m;
  for (const auto& d : n.all) m.add(d);
  if (m.count < options.min_support) return;
  const Principal p = principal_of(m);
  const double sigma = std::sqrt(p.values[1]);
  const bool straight = p.values[2] > 16.0 * p.values[1] && sigma < 0.15 * cell_m + options.noise_m;
  if (!straight) return;
  const Eigen::Vector3d direction = p.axes.col(2);
  const Eigen::Vector3d foot = p.centroid - direction * direction.dot(p.centroid);
  out.push_back({(n.center + foot).cast<float>(), direction.cast<float>(),
                 static_cast<float>(sigma), saturated(m.count * n.density), SurfaceKind::kLine, 0});
}

/// Enough points to tell that they lie on no plane.
bool is_clutter(const Neighbourhood& n, const FitOptions& options) {
  return options.planes && options.lines &&
         n.own.size() >= static_cast<std::size_t>(options.min_support);
}

/// Do these planes together explain the cell's own points, but for stray ones?
bool explain(const std::vector<Surface>& planes, std::size_t first, const Neighbourhood& n,
             const FitOptions& options) {
  constexpr double kShare = 0.8;
  int explained = 0;
  for (const Eigen::Vector3d& d : n.own) {
    for (std::size_t i = first; i < planes.size(); ++i) {
      const Eigen::Vector3d from = d + n.center - planes[i].center.cast<double>();
      if (std::abs(planes[i].normal.cast<double>().dot(from)) > 4.0 * options.noise_m) continue;
      ++explained;
      break;
    }
  }
  return explained >= kShare * static_cast<double>(n.own.size());
}

Surface clutter_at(const Eigen::Vector3d& center) {
  return {center.cast<float>(), Eigen::Vector3f::Zero(), 0, 1, SurfaceKind::kClutter, 0};
}

}  // namespace

void fit_cell(const PointGrid& grid, const Cell& cell, const FitOptions& options,
              std::vector<Surface>& out) {
  const Neighbourhood n = gather(grid, cell, options);
  const std::size_t first = out.size();
  if (options.planes) {
    const auto plane = single_plane(n, grid.cell_m(), options);
    if (plane && explains(*plane, n.own, options)) {
      out.push_back(surface_of(*plane, n.center));
    } else if (n.all.size() >= static_cast<std::size_t>(options.min_support)) {
      several_planes(n, grid.cell_m(), options, out);
      if (!explain(out, first, n, options)) out.resize(first);
    }
  }
  if (options.lines && out.size() == first) line_through(n, grid.cell_m(), options, out);
  if (out.size() == first && is_clutter(n, options)) out.push_back(clutter_at(n.center));
  for (std::size_t i = first; i + 1 < out.size(); ++i) out[i].more = 1;
}

Thickness plane_thickness(const PointGrid& grid, const Cell& cell, const FitOptions& options) {
  const Neighbourhood n = gather(grid, cell, options);
  Moments m;
  for (const auto& d : n.all) m.add(d);
  const auto plane = plane_through(m, 2 * options.min_support);
  return plane ? Thickness{plane->sigma_m, plane->support} : Thickness{};
}

}  // namespace holdfast::map
