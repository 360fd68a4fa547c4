#pragma once

#include <cmath>
#include <limits>
#include <numeric>

#include "holdfast/registration/correspondences.hpp"
#include "holdfast/registration/point_to_line.hpp"

/// The body of `associate`, for the maps that it is made for. Whoever only calls it with a
/// PriorMap needs correspondences.hpp alone.
namespace holdfast::registration {
namespace association {

inline constexpr std::size_t kChunk = 1024;

/// The plane that a point is paired with.
struct Choice {
  const map::Surface* surface = nullptr;
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  float information = 0;  ///< 1 / variance of the point's distance to the plane
};

/// What associating a range of points needs, in float.
template <SurfaceMap Map>
struct Query {
  const Map& map;
  const AssociationOptions& options;
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  Eigen::Vector3f p_lidar;  ///< relative to the anchor

  Choice choose(const Eigen::Vector3f& p) const {
    const auto hit = map.find(options.level, p);
    if (hit.surface != nullptr) return choose_in_cell(p, hit);
    if (!options.coarser_if_none || options.level + 1 >= map::kLevels) return {};
    const auto coarse = map.find(options.level + 1, p);
    return coarse.surface == nullptr ? Choice{} : choose_in_cell(p, coarse);
  }

  /// The nearest plane of a cell, unless the point may as well belong to the next one: a wrong
  /// plane at an edge is worse than none.
  template <class Hit>
  Choice choose_in_cell(const Eigen::Vector3f& p, const Hit& hit) const {
    const Eigen::Vector3f in_tile = p - hit.corner;
    Choice best;
    float least = options.gate_m;
    float next_sigmas = std::numeric_limits<float>::infinity();
    for (const map::Surface* s = hit.surface;; ++s) {
      if (s->kind == map::SurfaceKind::kPlane) {
        const float distance = std::abs(s->normal.dot(in_tile - s->center));
        const float information = information_of(p, *s);
        const float sigmas = distance * std::sqrt(information);
        if (distance < least) {
          if (best.surface != nullptr) next_sigmas = std::min(next_sigmas, best_sigmas(best, p));
          least = distance;
          best = {s, hit.corner, information};
        } else {
          next_sigmas = std::min(next_sigmas, sigmas);
        }
      }
      if (s->more == 0) break;
    }
    return next_sigmas < options.ambiguity_sigmas ? Choice{} : best;
  }

  float best_sigmas(const Choice& c, const Eigen::Vector3f& p) const {
    const float distance = c.surface->normal.dot(p - c.corner - c.surface->center);
    return std::abs(distance) * std::sqrt(c.information);
  }

  /// 1 / variance of the distance of `p` to the plane.
  float information_of(const Eigen::Vector3f& p, const map::Surface& s) const {
    const Eigen::Vector3f ray = p - p_lidar;
    const float along = s.normal.dot(ray);
    const float cosine_sq = along * along / ray.squaredNorm();
    return 1.0F / (options.range_sigma_m * options.range_sigma_m * cosine_sq +
                   s.sigma_m * s.sigma_m + options.surface_sigma_m * options.surface_sigma_m);
  }
};

template <SurfaceMap Map>
std::size_t associate_range(const Query<Map>& query, const BodyPoints& points, std::size_t begin,
                            std::size_t end, Correspondences& out) {
  std::size_t matches = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3f& q = points.points[i];
    const Eigen::Vector3f p = query.R * q + query.t;
    const Choice choice = query.choose(p);
    out.px[i] = q.x();
    out.py[i] = q.y();
    out.pz[i] = q.z();
    out.age_s[i] = points.age_s[i];
    if (choice.surface == nullptr) {
      out.nx[i] = out.ny[i] = out.nz[i] = out.offset[i] = out.information[i] = 0;
      continue;
    }
    const Eigen::Vector3f& n = choice.surface->normal;
    out.nx[i] = n.x();
    out.ny[i] = n.y();
    out.nz[i] = n.z();
    out.offset[i] = n.dot(choice.surface->center + choice.corner);
    out.information[i] = choice.information;
    ++matches;
  }
  return matches;
}

}  // namespace association

template <SurfaceMap Map>
std::size_t associate(const Map& map, const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                      const BodyPoints& points, const AssociationOptions& options, WorkerPool& pool,
                      Correspondences& out) {
  out.resize(points.size());
  const association::Query<Map> query{
      map, options, T_anchor_body.rotation.toRotationMatrix().cast<float>(),
      T_anchor_body.translation.cast<float>(), (T_anchor_body * p_body_lidar).cast<float>()};
  std::vector<std::size_t> matches(chunk_count(points.size(), association::kChunk));
  for_each_chunk(pool, points.size(), association::kChunk,
                 [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                   matches[chunk] = association::associate_range(query, points, begin, end, out);
                 });
  const std::size_t planes = std::accumulate(matches.begin(), matches.end(), std::size_t{0});
  if (!options.lines) return planes;
  return planes + add_line_pairs(map, T_anchor_body, p_body_lidar, points, options, out);
}

}  // namespace holdfast::registration
