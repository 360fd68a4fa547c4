#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "holdfast/core/parallel.hpp"
#include "holdfast/core/result.hpp"
#include "holdfast/io/point_cloud.hpp"
#include "holdfast/map/map_info.hpp"

namespace holdfast::map {

/// A cloud to make a map of, in the map frame. With `edges`, `cloud` holds planar points only and
/// lines are fitted to the edges.
struct MapSource {
  io::PointCloud cloud;
  std::optional<io::PointCloud> edges;
  std::string name;  ///< kept in map.yaml
};

/// Told after each tile: tiles done, tiles in all.
using BuildProgress = std::function<void(std::size_t, std::size_t)>;

/// Adds files to a map that is complete but for its name: its folder, and what map.yaml says.
using MapFinish = std::function<Status(const std::filesystem::path&, MapInfo&)>;

/// Makes a map folder at `path`, whole or not at all: fits planes and lines at three resolutions
/// and lays them out for look-up. The side of the finest cell follows from the spacing of the
/// points. Same cloud, same bytes, with any number of threads. A cloud too small to fit anything to
/// is an error.
Result<MapInfo> build_map(MapSource source, const std::filesystem::path& path, WorkerPool& pool,
                          const BuildProgress& progress = {}, const MapFinish& finish = {});

/// Typical distance between neighbouring points on a surface, from the number of points in occupied
/// cells; what build_map chooses its cells by.
double estimate_spacing(const io::PointCloud& cloud);

}  // namespace holdfast::map
