#include "holdfast/relocalization/occupancy/standpoints.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::relocalization {
namespace {

int cell_of(float metres) { return static_cast<int>(std::floor(metres / kCellM)); }

}  // namespace

Standpoints::Standpoints(const std::vector<places::Place>& places, const OccupancyPyramid& map,
                         const Reach& reach)
    : levels_(OccupancyPyramid::kLevels) {
  if (places.empty()) return;
  Eigen::Vector3f low = places.front().position;
  Eigen::Vector3f high = low;
  for (const places::Place& place : places) {
    low = low.cwiseMin(place.position);
    high = high.cwiseMax(place.position);
  }
  const int aside = cell_of(reach.aside_m) + 1;
  low_ = {cell_of(low.x()) - aside, cell_of(low.y()) - aside, cell_of(low.z() + reach.lowest_m)};
  Level& finest = levels_[0];
  finest.width = cell_of(high.x()) + aside + 1 - low_.x;
  finest.height = cell_of(high.y()) + aside + 1 - low_.y;
  words_ = (cell_of(high.z() + reach.highest_m) - low_.z) / kLanes + 1;
  finest.columns.assign(static_cast<std::size_t>(finest.width) * finest.height * words_, 0);
  for (const places::Place& place : places) spread(place, map, reach);
  for (int level = 1; level < OccupancyPyramid::kLevels; ++level) make_coarser(level);
  const int top = OccupancyPyramid::kLevels - 1;
  for (int y = 0; y < levels_[top].height; ++y) {
    for (int x = 0; x < levels_[top].width; ++x) {
      for (int word = 0; word < words_; ++word) {
        const Block block{
            x + (low_.x >> top), y + (low_.y >> top), word,
            levels_[top]
                .columns[(static_cast<std::size_t>(y) * levels_[top].width + x) * words_ + word]};
        if (block.lanes != 0) roots_.push_back(block);
      }
    }
  }
}

/// From the place's cell over free ones; obstacles are reached, not passed.
void Standpoints::spread(const places::Place& place, const OccupancyPyramid& map,
                         const Reach& reach) {
  const Eigen::Vector3f& p = place.position;
  const int aside = cell_of(reach.aside_m) + 1, side = 2 * aside + 1;
  const Cell middle{cell_of(p.x()), cell_of(p.y()), cell_of(p.z())};
  std::vector<std::uint8_t> reached(static_cast<std::size_t>(side) * side, 0);
  std::vector<Cell> front;
  const auto reach_cell = [&](int x, int y) {
    const float dx = static_cast<float>(x - middle.x), dy = static_cast<float>(y - middle.y);
    if (kCellM * std::sqrt(dx * dx + dy * dy) > reach.aside_m) return;
    std::uint8_t& seen =
        reached[static_cast<std::size_t>(y - middle.y + aside) * side + (x - middle.x + aside)];
    if (seen != 0) return;
    seen = 1;
    mark(x, y, p.z(), reach);
    if (!map.occupied({x, y, middle.z})) front.push_back({x, y, middle.z});
  };
  reach_cell(middle.x, middle.y);
  while (!front.empty()) {
    const Cell cell = front.back();
    front.pop_back();
    reach_cell(cell.x + 1, cell.y);
    reach_cell(cell.x - 1, cell.y);
    reach_cell(cell.x, cell.y + 1);
    reach_cell(cell.x, cell.y - 1);
  }
}

void Standpoints::mark(int x, int y, float z, const Reach& reach) {
  const auto column = static_cast<std::size_t>(y - low_.y) * levels_[0].width + (x - low_.x);
  for (int k = cell_of(z + reach.lowest_m); k <= cell_of(z + reach.highest_m); ++k) {
    levels_[0].columns[column * words_ + (k - low_.z) / kLanes] |= std::uint64_t{1}
                                                                   << ((k - low_.z) % kLanes);
  }
}

void Standpoints::make_coarser(int level) {
  const Level& fine = levels_[level - 1];
  Level& coarse = levels_[level];
  const int fine_x = low_.x >> (level - 1), fine_y = low_.y >> (level - 1);
  coarse.width = ((fine_x + fine.width - 1) >> 1) - (low_.x >> level) + 1;
  coarse.height = ((fine_y + fine.height - 1) >> 1) - (low_.y >> level) + 1;
  coarse.columns.assign(static_cast<std::size_t>(coarse.width) * coarse.height * words_, 0);
  for (int y = 0; y < fine.height; ++y) {
    for (int x = 0; x < fine.width; ++x) {
      const int cx = ((fine_x + x) >> 1) - (low_.x >> level);
      const int cy = ((fine_y + y) >> 1) - (low_.y >> level);
      for (int w = 0; w < words_; ++w) {
        coarse.columns[(static_cast<std::size_t>(cy) * coarse.width + cx) * words_ + w] |=
            fine.columns[(static_cast<std::size_t>(y) * fine.width + x) * words_ + w];
      }
    }
  }
}

}  // namespace holdfast::relocalization
