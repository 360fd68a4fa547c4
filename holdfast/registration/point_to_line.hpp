#pragma once

#include <Eigen/Core>
#include <cmath>

#include "holdfast/registration/correspondences.hpp"

namespace holdfast::registration {

/// A line of a map, relative to the map's anchor, and how well a point's distance from it is known.
struct LineMatch {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();
  float sigma_m = 0;  ///< RMS distance of the supporting points
  bool found = false;
};

/// The nearest line of the cell of `p` (relative to the anchor) within the gate; none where a
/// second line of the cell is within the gate too.
template <class Map>
LineMatch nearest_line(const Map& map, int level, const Eigen::Vector3f& p, float gate_m) {
  LineMatch match;
  const auto hit = map.find(level, p);
  if (hit.surface == nullptr) return match;
  for (const map::Surface* s = hit.surface;; ++s) {
    if (s->kind == map::SurfaceKind::kLine) {
      const Eigen::Vector3f point = hit.corner + s->center;
      const Eigen::Vector3f d = p - point;
      const float along = d.dot(s->normal);
      if (d.squaredNorm() - along * along < gate_m * gate_m) {
        if (match.found) return {};
        match = {point, s->normal, s->sigma_m, true};
      }
    }
    if (s->more == 0) return match;
  }
}

/// Appends the pairs of a point `q` (body frame) with a line: its distance from the line (article
/// 3.2.2, r_E) as the distances from the two planes through the line of which one holds the ray's
/// direction and the other does not. Errors of range act on the first alone, so that the two are
/// independent and a line needs no residual of its own kind.
void append_line_pair(const LineMatch& line, const Eigen::Vector3f& q, float age_s,
                      const Eigen::Vector3f& ray, const AssociationOptions& options,
                      Correspondences& out);

/// Pairs the points that found no plane with lines of the map at `T_anchor_body`. The pairs stand
/// behind those of `associate`: `out` grows by two a line. Returns the number of points paired.
template <class Map>
std::size_t add_line_pairs(const Map& map, const SE3& T_anchor_body,
                           const Eigen::Vector3d& p_body_lidar, const BodyPoints& points,
                           const AssociationOptions& options, Correspondences& out) {
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_anchor_body.translation.cast<float>();
  const Eigen::Vector3f p_lidar = (T_anchor_body * p_body_lidar).cast<float>();
  std::size_t matches = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (out.information[i] > 0) continue;
    const Eigen::Vector3f p = R * points.points[i] + t;
    const LineMatch line = nearest_line(map, options.level, p, options.gate_m);
    if (!line.found) continue;
    append_line_pair(line, points.points[i], points.age_s[i], p - p_lidar, options, out);
    ++matches;
  }
  return matches;
}

}  // namespace holdfast::registration
