#include "holdfast/odometry/surroundings/local_pairing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::odometry {
namespace {

constexpr double kWeakShare = 0.02;  // of all information, below which a direction is weak
constexpr std::size_t kChunk = 1024, kBlock = 64;
constexpr int kManyPlanes = 10;
constexpr double kRobustScale = 12.0;  // wide: the pose is still a prediction

float dot_normal(const Eigen::Vector3f& u, const registration::Correspondences& c, std::size_t i) {
  return u.x() * c.nx[i] + u.y() * c.ny[i] + u.z() * c.nz[i];
}

/// Takes `u` out of the normals that are at right angles to it but for `sine`; the distances at
/// `T_anchor_body` stay as they are.
void take_out(const Eigen::Vector3f& u, float sine, const SE3& T_anchor_body,
              registration::Correspondences& c) {
  const Eigen::Vector3f u_body =
      (T_anchor_body.rotation.conjugate() * u.cast<double>()).cast<float>();
  const float place = u.dot(T_anchor_body.translation.cast<float>());
  for (std::size_t i = 0; i < c.size(); ++i) {
    float along = dot_normal(u, c, i);
    along = std::abs(along) < sine ? along : 0.0F;
    const float at = u_body.x() * c.px[i] + u_body.y() * c.py[i] + u_body.z() * c.pz[i] + place;
    c.nx[i] -= along * u.x();
    c.ny[i] -= along * u.y();
    c.nz[i] -= along * u.z();
    c.offset[i] -= along * at;
  }
}

/// One scan at one pose, as its points are paired.
struct Query {
  const LocalMap& map;
  const registration::AssociationOptions& options;
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  Eigen::Vector3f lidar;  ///< relative to the anchor

  Eigen::Vector3f in_map(const Eigen::Vector3f& q) const { return R * q + t; }

  /// 1 / variance of the distance of `p` to the plane; 0 where the two are no pair. A thin thing
  /// has two faces: what is seen of it from behind is not the plane that was seen from before.
  float information(const Eigen::Vector3f& p, const LocalMap::Hit& hit) const {
    const map::Surface& s = *hit.surface;
    if (!(std::abs(s.normal.dot(p - hit.corner - s.center)) < options.gate_m)) return 0.0F;
    if (s.normal.dot(lidar - hit.corner - s.center) <= 0) return 0.0F;
    const Eigen::Vector3f ray = p - lidar;
    const float along = s.normal.dot(ray);
    const float cosine_sq = along * along / ray.squaredNorm();
    return 1.0F / (options.range_sigma_m * options.range_sigma_m * cosine_sq +
                   s.sigma_m * s.sigma_m + options.surface_sigma_m * options.surface_sigma_m);
  }
};

void set_pair(const Query& query, const Eigen::Vector3f& p, const LocalMap::Hit& hit, std::size_t i,
              registration::Correspondences& out) {
  out.information[i] = hit.surface == nullptr ? 0.0F : query.information(p, hit);
  if (out.information[i] <= 0) {
    out.nx[i] = out.ny[i] = out.nz[i] = out.offset[i] = 0;
    return;
  }
  const Eigen::Vector3f& n = hit.surface->normal;
  out.nx[i] = n.x();
  out.ny[i] = n.y();
  out.nz[i] = n.z();
  out.offset[i] = n.dot(hit.surface->center + hit.corner);
}

/// Pairs [begin, end), at most kBlock. What all of them need of the map, which lies anywhere in
/// memory, is fetched at the same time.
void pair_block(const Query& query, const registration::BodyPoints& points, std::size_t begin,
                std::size_t end, registration::Correspondences& out) {
  std::array<Eigen::Vector3f, kBlock> p;
  std::array<LocalMap::Hit, kBlock> hits;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3f& q = points.points[i];
    p[i - begin] = query.in_map(q);
    query.map.prefetch(query.options.level, p[i - begin]);
    out.px[i] = q.x();
    out.py[i] = q.y();
    out.pz[i] = q.z();
    out.age_s[i] = points.age_s[i];
  }
  for (std::size_t i = begin; i < end; ++i) {
    hits[i - begin] = query.map.find(query.options.level, p[i - begin]);
    __builtin_prefetch(hits[i - begin].surface);
  }
  for (std::size_t i = begin; i < end; ++i) set_pair(query, p[i - begin], hits[i - begin], i, out);
}

/// registration::associate for a map with one plane a cell.
std::size_t pair_all(const Query& query, const registration::BodyPoints& points, WorkerPool& pool,
                     registration::Correspondences& out) {
  out.resize(points.size());
  for_each_chunk(pool, points.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += kBlock) {
      pair_block(query, points, i, std::min(i + kBlock, end), out);
    }
  });
  std::size_t pairs = 0;
  for (const float information : out.information) pairs += information > 0 ? 1 : 0;
  return pairs;
}

/// A pair that speaks about a weak direction, and the plane that it was paired with.
struct Witness {
  const map::Surface* plane;
  std::size_t pair;
  bool firm;
};

using Witnesses = std::vector<Witness>;

/// Those of `u`, plane by plane.
void find_witnesses(const LocalMap& map, int level, const Eigen::Vector3f& u, float sine,
                    const SE3& T_anchor_body, const registration::Correspondences& c,
                    Witnesses& witnesses) {
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_anchor_body.translation.cast<float>();
  witnesses.clear();
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!(c.information[i] > 0) || std::abs(dot_normal(u, c, i)) < sine) continue;
    const LocalMap::Hit hit = map.find(level, R * Eigen::Vector3f(c.px[i], c.py[i], c.pz[i]) + t);
    witnesses.push_back({hit.surface, i, hit.firm});
  }
  std::stable_sort(witnesses.begin(), witnesses.end(), [](const Witness& a, const Witness& b) {
    return std::less<>()(a.plane, b.plane);
  });
}

Witnesses::const_iterator end_of_plane(Witnesses::const_iterator begin, const Witnesses& all) {
  return std::find_if(begin, all.end(), [&](const Witness& w) { return w.plane != begin->plane; });
}

/// Many planes would have to err alike. Of a few, only those that are firm prove anything, and the
/// points of one share its error: however many they are, they know no more than it does.
void doubt_few(const Witnesses& witnesses, registration::Correspondences& c) {
  int planes = 0;
  for (auto at = witnesses.begin(); at != witnesses.end(); at = end_of_plane(at, witnesses)) {
    ++planes;
  }
  if (planes >= kManyPlanes) return;
  for (auto at = witnesses.begin(); at != witnesses.end();) {
    const auto end = end_of_plane(at, witnesses);
    const auto others = static_cast<float>(end - at - 1);
    for (; at != end; ++at) {
      float& information = c.information[at->pair];
      const float shared = at->plane->sigma_m * at->plane->sigma_m;
      information = at->firm ? 1.0F / (1.0F / information + others * shared) : 0.0F;
    }
  }
}

}  // namespace

std::size_t LocalPairing::associate(const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                                    const registration::BodyPoints& points,
                                    const registration::AssociationOptions& options,
                                    WorkerPool& pool, registration::Correspondences& out) const {
  const Query query{map_, options, T_anchor_body.rotation.toRotationMatrix().cast<float>(),
                    T_anchor_body.translation.cast<float>(),
                    (T_anchor_body * p_body_lidar).cast<float>()};
  const std::size_t pairs = pair_all(query, points, pool, out);
  const auto equations = registration::linearise(out, T_anchor_body, kRobustScale, pool, partials_);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      registration::position_information(equations.H));
  const double least = kWeakShare * solver.eigenvalues().sum();
  Witnesses witnesses;
  for (int i = 0; i < 2; ++i) {
    if (solver.eigenvalues()[i] >= least) break;
    const Eigen::Vector3f u = solver.eigenvectors().col(i).cast<float>();
    const auto sine = static_cast<float>(parallel_sine_);
    take_out(u, sine, T_anchor_body, out);
    if (!settled_) continue;
    find_witnesses(map_, options.level, u, sine, T_anchor_body, out, witnesses);
    doubt_few(witnesses, out);
  }
  return pairs;
}

}  // namespace holdfast::odometry
