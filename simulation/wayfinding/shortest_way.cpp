#include "simulation/wayfinding/shortest_way.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace holdfast::simulation {

ShortestWays::ShortestWays(const Grid& grid, const std::vector<float>& cost, std::size_t from)
    : total_(grid.size(), std::numeric_limits<float>::infinity()),
      before_(grid.size(), static_cast<std::uint32_t>(from)) {
  using Entry = std::pair<float, std::uint32_t>;  // equal costs: the smaller cell first
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  total_[from] = 0;
  open.emplace(0.0F, static_cast<std::uint32_t>(from));
  while (!open.empty()) {
    const auto [reached, cell] = open.top();
    open.pop();
    if (reached > total_[cell]) continue;
    grid.around(cell, [&, reached = reached, cell = cell](std::size_t k, double steps) {
      const auto step = static_cast<float>(steps * grid.cell_m);
      const float there = reached + step * 0.5F * (cost[cell] + cost[k]);
      if (!(there < total_[k])) return;
      total_[k] = there;
      before_[k] = cell;
      open.emplace(there, static_cast<std::uint32_t>(k));
    });
  }
}

std::size_t ShortestWays::farthest() const {
  std::size_t best = 0;
  float most = -1;
  for (std::size_t i = 0; i < total_.size(); ++i) {
    if (total_[i] == std::numeric_limits<float>::infinity() || total_[i] <= most) continue;
    most = total_[i];
    best = i;
  }
  return best;
}

std::vector<std::size_t> ShortestWays::way_to(std::size_t to) const {
  std::vector<std::size_t> way = {to};
  while (total_[way.back()] > 0) way.push_back(before_[way.back()]);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace holdfast::simulation
