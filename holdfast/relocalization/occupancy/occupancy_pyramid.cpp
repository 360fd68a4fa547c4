#include "holdfast/relocalization/occupancy/occupancy_pyramid.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/map/prior_map.hpp"

namespace holdfast::relocalization {
namespace {

int cell_of(float metres) { return static_cast<int>(std::floor(metres / kCellM)); }

}  // namespace

OccupancyPyramid::OccupancyPyramid(std::span<const Eigen::Vector3f> points, float grown_m,
                                   float margin_m) {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  Eigen::Vector3f high = Eigen::Vector3f::Zero();
  if (!points.empty()) low = high = points.front();
  for (const Eigen::Vector3f& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int margin = cell_of(margin_m) + (1 << kLevels);
  low_ = {cell_of(low.x()) - margin, cell_of(low.y()) - margin, cell_of(low.z() - grown_m)};
  width_ = cell_of(high.x()) + margin + 1 - low_.x;
  height_ = cell_of(high.y()) + margin + 1 - low_.y;
  words_ = (cell_of(high.z() + grown_m) - low_.z) / kLanes + 1;
  levels_.resize(kLevels);
  levels_[0] = {0, static_cast<std::size_t>(width_) + 1, static_cast<std::size_t>(height_) + 1, {}};
  levels_[0].columns.assign(levels_[0].width * levels_[0].height * words_, 0);
  for (const Eigen::Vector3f& p : points) {
    for (int corner = 0; corner < (grown_m > 0 ? 8 : 1); ++corner) {
      const auto grown = [&](int axis) {
        return cell_of(p[axis] + ((corner >> axis & 1) != 0 ? grown_m : -grown_m));
      };
      const int x = grown(0) - low_.x, y = grown(1) - low_.y, z = grown(2) - low_.z;
      const std::size_t column = static_cast<std::size_t>(y) * levels_[0].width + x;
      levels_[0].columns[column * words_ + z / kLanes] |= std::uint64_t{1} << (z % kLanes);
    }
  }
  for (int level = 1; level < kLevels; ++level) make_coarser(level);
}

/// From the level below: blocks of half the side. A column holds for all blocks that begin at one
/// of its 2^shift places: the last of them reaches farthest.
void OccupancyPyramid::make_coarser(int level) {
  const Level& fine = levels_[level - 1];
  Level& coarse = levels_[level];
  coarse.shift = std::max(0, level - 2);
  coarse.width = static_cast<std::size_t>(width_ >> coarse.shift) + 1;
  coarse.height = static_cast<std::size_t>(height_ >> coarse.shift) + 1;
  coarse.columns.assign(coarse.width * coarse.height * words_, 0);
  const int half = 1 << (level - 1);
  const int last = (1 << coarse.shift) - 1 + half;
  for (std::size_t y = 0; y < coarse.height; ++y) {
    for (std::size_t x = 0; x < coarse.width; ++x) {
      std::uint64_t* to = &coarse.columns[(y * coarse.width + x) * words_];
      for (const int dy : {0, half, last}) {
        for (const int dx : {0, half, last}) {
          const std::size_t fx = ((x << coarse.shift) + dx) >> fine.shift;
          const std::size_t fy = ((y << coarse.shift) + dy) >> fine.shift;
          if (fx >= fine.width || fy >= fine.height) continue;
          const std::uint64_t* from = &fine.columns[(fy * fine.width + fx) * words_];
          for (int w = 0; w < words_; ++w) to[w] |= from[w];
        }
      }
    }
  }
}

Result<OccupancyPyramid> OccupancyPyramid::of_map(const std::filesystem::path& dir,
                                                  const map::MapInfo& info, float grown_m,
                                                  float margin_m) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(info.points);
  for (const map::TileInfo& tile : info.tiles) {
    auto some = map::PriorMap::read_tile_points(dir, tile);
    if (!some) return some.error();
    points.insert(points.end(), some->begin(), some->end());
  }
  return OccupancyPyramid(points, grown_m, margin_m);
}

bool OccupancyPyramid::occupied(const Cell& cell) const {
  const int z = cell.z - low_.z;
  if (!reaches(cell.x, cell.y) || z < 0 || z >= words_ * kLanes) return false;
  return (column(0, cell.x, cell.y)[z / kLanes] >> (z % kLanes) & 1U) != 0;
}

std::size_t OccupancyPyramid::size() const {
  std::size_t words = 0;
  for (const Level& level : levels_) words += level.columns.size();
  return words;
}

}  // namespace holdfast::relocalization
