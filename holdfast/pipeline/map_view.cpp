#include "holdfast/pipeline/map_view.hpp"

#include <fmt/format.h>

#include <iterator>

#include "holdfast/map/prior_map.hpp"

namespace holdfast::pipeline {

Result<std::string> map_view_json(const std::filesystem::path& map_dir, const map::MapInfo& info) {
  constexpr std::uint64_t kMostPoints = 40'000;
  const std::uint64_t step =
      std::max<std::uint64_t>(1, (info.points + kMostPoints - 1) / kMostPoints);
  std::string text = "{\"points\": [";
  std::uint64_t number = 0;
  bool first = true;
  for (const map::TileInfo& tile : info.tiles) {
    auto points = map::PriorMap::read_tile_points(map_dir, tile);
    if (!points) return points.error();
    for (const Eigen::Vector3f& p : *points) {
      if (number++ % step != 0) continue;
      const Eigen::Vector3d q = p.cast<double>() + info.origin;
      fmt::format_to(std::back_inserter(text), "{}[{:.2f},{:.2f},{:.2f}]", first ? "" : ",", q.x(),
                     q.y(), q.z());
      first = false;
    }
  }
  return text + "]}\n";
}

}  // namespace holdfast::pipeline
