#include "holdfast/relocalization/occupancy/standpoints.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::relocalization {
namespace {

int cell_of(float metres) { return static_cast<int>(std::floor(metres / kCellM)); }

}  // namespace

Standpoints::Standpoints(const std::vector<places::Place>& places, const Reach& reach)
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
  for (const places::Place& place : places) mark(place, reach);
  for (int level = 1; level < OccupancyPyramid::kLevels; ++level) make_coarser(level);
  const int top = OccupancyPyramid::kLevels - 1;
  for (int y = 0; y < levels_[top].height; ++y) {
    for (int x = 0; x < levels_[top].width; ++x) {
      for (int word = 0; word < words_; ++word) {
        const Block block{x + (low_.x >> top), y + (low_.y >> top), word,
                          levels_[top].columns[(static_cast<std::size_t>(y) * levels_[top].width +
                                                x) * words_ + word]};
        if (block.lanes != 0) roots_.push_back(block);
      }
    }
  }
}

void Standpoints::mark(const places::Place& place, const Reach& reach) {
  const Eigen::Vector3f& p = place.position;
  const int aside = cell_of(reach.aside_m) + 1;
  for (int y = cell_of(p.y()) - aside; y <= cell_of(p.y()) + aside; ++y) {
    for (int x = cell_of(p.x()) - aside; x <= cell_of(p.x()) + aside; ++x) {
      const float dx = kCellM * (static_cast<float>(x) + 0.5F) - p.x();
      const float dy = kCellM * (static_cast<float>(y) + 0.5F) - p.y();
      if (dx * dx + dy * dy > reach.aside_m * reach.aside_m) continue;
      if (x < low_.x || y < low_.y || x >= low_.x + levels_[0].width ||
          y >= low_.y + levels_[0].height) {
        continue;
      }
      const auto column = static_cast<std::size_t>(y - low_.y) * levels_[0].width + (x - low_.x);
      for (int z = cell_of(p.z() + reach.lowest_m); z <= cell_of(p.z() + reach.highest_m); ++z) {
        levels_[0].columns[column * words_ + (z - low_.z) / kLanes] |= std::uint64_t{1}
                                                                       << ((z - low_.z) % kLanes);
      }
    }
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
