#include <cmath>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/registration/fit_at_query.hpp"

namespace holdfast::registration {
namespace {

constexpr float kOnSurfaceM = 0.05F;  // and nearer than three times its thickness
constexpr double kReachM = 1.0;       // surfaces of a tile's points lie in this tile

enum class Kind { kNone, kEdge, kPlane };

/// What the surfaces of the cell of `p` (relative to the anchor) say of it.
Kind kind_of(const map::PriorMap& map, const Eigen::Vector3f& p) {
  const map::PriorMap::Hit hit = map.find(0, p);
  if (hit.surface == nullptr) return Kind::kNone;
  int planes = 0;
  for (const map::Surface* s = hit.surface;; ++s) {
    const Eigen::Vector3f d = p - hit.corner - s->center;
    const float limit = std::max(kOnSurfaceM, 3.0F * s->sigma_m);
    if (s->kind == map::SurfaceKind::kLine) {
      if (d.squaredNorm() - std::pow(d.dot(s->normal), 2.0F) < limit * limit) return Kind::kEdge;
    } else if (std::abs(d.dot(s->normal)) < limit) {
      ++planes;
    }
    if (s->more == 0) break;
  }
  return planes >= 2 ? Kind::kEdge : planes == 1 ? Kind::kPlane : Kind::kNone;
}

}  // namespace

Result<FeatureClouds> classify_points(const std::filesystem::path& map_dir) {
  auto map = map::PriorMap::open(map_dir);
  if (!map) return map.error();
  const Eigen::Vector3d origin = map->info().origin;
  FeatureClouds clouds;
  for (const map::TileInfo& tile : map->info().tiles) {
    const Eigen::Vector3d middle =
        origin + map::kTileSizeM * Eigen::Vector3d(tile.ix + 0.5, tile.iy + 0.5, 0);
    if (auto focused = map->focus(middle, kReachM); !focused) return focused.error();
    const auto points = map::PriorMap::read_tile_points(map_dir, tile);
    if (!points) return points.error();
    const Eigen::Vector3f shift = (origin - map->anchor()).cast<float>();
    for (const Eigen::Vector3f& p : *points) {
      const Kind kind = kind_of(*map, p + shift);
      if (kind == Kind::kEdge) clouds.edges.push_back(p);
      if (kind == Kind::kPlane) clouds.planes.push_back(p);
    }
  }
  return clouds;
}

}  // namespace holdfast::registration
