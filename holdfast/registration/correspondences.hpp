#pragma once

#include <Eigen/Core>
#include <concepts>
#include <vector>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/se3.hpp"
#include "holdfast/map/prior_map.hpp"

namespace holdfast::registration {

/// The points of a scan that are to be matched: deskewed to the last point's time, in the body
/// frame of that time (metres), with the age of each point (seconds, <= 0: before the end of the
/// scan).
struct BodyPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> age_s;

  std::size_t size() const { return points.size(); }
  void resize(std::size_t n) {
    points.resize(n);
    age_s.resize(n);
  }
};

/// Pairs of a point and a plane of the prior map, as columns, ready for vector instructions.
/// Positions are relative to the map's anchor. `information` is 0 where a point found no plane, so
/// that pair i belongs to point i.
struct Correspondences {
  std::vector<float> px, py, pz;   ///< point in the body frame
  std::vector<float> nx, ny, nz;   ///< unit normal of the plane in the map frame
  std::vector<float> offset;       ///< the plane is n . x = offset, x relative to the anchor
  std::vector<float> information;  ///< 1 / variance of the residual, 1/m^2
  std::vector<float> age_s;

  std::size_t size() const { return px.size(); }
  void resize(std::size_t n);
};

/// Where surfaces are looked up. `find(level, p)` is the first surface of the cell that holds `p`
/// (relative to the anchor, metres), none where nothing is known; its centre counts from `corner`.
/// `anchor()` is the anchor's place in the frame of the map, in which poses are given.
template <class Map>
concept SurfaceMap = requires(const Map& map, const Eigen::Vector3f& p) {
  { map.find(0, p).surface } -> std::convertible_to<const map::Surface*>;
  { map.find(0, p).corner } -> std::convertible_to<Eigen::Vector3f>;
  { map.anchor() } -> std::convertible_to<Eigen::Vector3d>;
};

/// How a point's plane is chosen and how well its distance is known.
struct AssociationOptions {
  int level = 0;                   ///< resolution of the map that is asked first
  bool coarser_if_none = true;     ///< ask the next coarser level where this one has nothing
  float gate_m = 0.3F;             ///< farther planes are no correspondence
  float range_sigma_m = 0.02F;     ///< of the LiDAR along the ray
  float surface_sigma_m = 0.003F;  ///< least error of a plane, added to its own thickness
  float ambiguity_sigmas = 3.0F;   ///< a point this near to a second plane of its cell is left out
  bool lines = false;              ///< pair points without a plane with lines (point_to_line.hpp)
};

/// Pairs each point with the nearest plane of its cell at the pose `T_anchor_body` (article 3.2.2
/// step 2; the planes are precomputed, a query is one look-up; defined in associate.hpp). The
/// variance of a residual is that of the range seen along the normal, (sigma_r cos(incidence))^2,
/// plus the plane's thickness: at grazing incidence a range error hardly moves a point off its
/// plane. Returns the number of pairs.
template <SurfaceMap Map>
std::size_t associate(const Map& map, const SE3& T_anchor_body, const Eigen::Vector3d& p_body_lidar,
                      const BodyPoints& points, const AssociationOptions& options, WorkerPool& pool,
                      Correspondences& out);

extern template std::size_t associate(const map::PriorMap& map, const SE3& T_anchor_body,
                                      const Eigen::Vector3d& p_body_lidar, const BodyPoints& points,
                                      const AssociationOptions& options, WorkerPool& pool,
                                      Correspondences& out);

}  // namespace holdfast::registration
