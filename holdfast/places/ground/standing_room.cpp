#include "holdfast/places/ground/standing_room.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "holdfast/map/tile.hpp"

namespace holdfast::places {
namespace {

constexpr float kLevelCosine = 0.9F;  // of the slope of a floor, at least
constexpr float kStepM = 0.3F;        // what is lower is ground, what is nearer is one floor
constexpr float kHeadM = 1.6F;        // so much must be free above the floor
constexpr float kClearM = 0.5F;       // radius
constexpr float kPassM = 0.3F;

constexpr int kColumns = static_cast<int>(map::kTileSizeM / kColumnM);

/// Appends the columns of the tile that a plane covers.
void add_columns(const map::Surface& plane, float reach_m, std::vector<Standing>& out) {
  const auto first = [&](float v) {
    return std::max(0, static_cast<int>(std::ceil((v - reach_m) / kColumnM - 0.5F)));
  };
  const auto last = [&](float v) {
    return std::min(kColumns - 1, static_cast<int>(std::floor((v + reach_m) / kColumnM - 0.5F)));
  };
  const Eigen::Vector3f& c = plane.center;
  const Eigen::Vector3f& n = plane.normal;
  for (int cy = first(c.y()); cy <= last(c.y()); ++cy) {
    for (int cx = first(c.x()); cx <= last(c.x()); ++cx) {
      Standing s{cx, cy};
      s.z_m = c.z() - (n.x() * (s.x_m() - c.x()) + n.y() * (s.y_m() - c.y())) / n.z();
      out.push_back(s);
    }
  }
}

/// Floors of a tile by column and height, counted from the tile's corner.
std::vector<Standing> floors_of(const map::Tile& tile, double cell_m) {
  const float reach_m = std::max(kColumnM, static_cast<float>(cell_m)) / 2;
  std::vector<Standing> floors;
  const map::Surface* surfaces = tile.surfaces(0);
  for (std::uint32_t i = 0; i < tile.header().levels[0].surface_count; ++i) {
    const map::Surface& s = surfaces[i];
    if (s.kind != map::SurfaceKind::kPlane || std::abs(s.normal.z()) < kLevelCosine) continue;
    add_columns(s, reach_m, floors);
  }
  std::sort(floors.begin(), floors.end(), [](const Standing& a, const Standing& b) {
    return std::tie(a.cy, a.cx, a.z_m) < std::tie(b.cy, b.cx, b.z_m);
  });
  return floors;
}

/// Is `next` of the same column and floor as `s`, which it follows?
bool is_same_floor(const Standing& s, const Standing& next) {
  return s.cy == next.cy && s.cx == next.cx && next.z_m - s.z_m < kStepM;
}

}  // namespace

Result<std::vector<Standing>> find_standing_room(const std::filesystem::path& dir,
                                                 const map::TileInfo& tile, double cell_m,
                                                 const VoxelWindow& window) {
  const auto opened = map::Tile::open(dir / (tile.stem() + ".tile"));
  if (!opened) return opened.error();
  const std::vector<Standing> floors = floors_of(*opened, cell_m);
  std::vector<Standing> room;
  for (std::size_t i = 0; i < floors.size(); ++i) {
    if (i + 1 < floors.size() && is_same_floor(floors[i], floors[i + 1])) continue;
    Standing s = floors[i];
    const Eigen::Vector3f base(s.x_m(), s.y_m(), s.z_m + kStepM);
    if (!window.is_free(tile.ix, tile.iy, base, kPassM, kHeadM - kStepM)) continue;
    s.clear = window.is_free(tile.ix, tile.iy, base, kClearM, kHeadM - kStepM);
    s.cx += tile.ix * kColumns;
    s.cy += tile.iy * kColumns;
    room.push_back(s);
  }
  return room;
}

}  // namespace holdfast::places
