#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "holdfast/map/fitting/surface_fit.hpp"
#include "holdfast/map/tile_format.hpp"

namespace holdfast::map {

/// The points that the surfaces of one tile are fitted to: those of the tile and of a margin around
/// it. Positions relative to the tile's corner. Edges and planes may be given apart (a map saved as
/// feature clouds); otherwise both lists are the same cloud and `shared` is true.
struct TilePoints {
  std::int32_t ix = 0, iy = 0;
  std::vector<Eigen::Vector3f> planes;
  std::vector<Eigen::Vector3f> edges;  ///< empty when shared
  bool shared = true;
};

struct TileBytes {
  std::vector<std::byte> bytes;
  std::array<std::uint64_t, kLevels> planes{};
  std::array<std::uint64_t, kLevels> lines{};
};

/// Margin around a tile, in metres, that TilePoints must cover for cells of `cell_m` at level 0.
double tile_margin_m(double cell_m);

/// Fits all surfaces of a tile and lays them out as a file. `cell_m` is the side of a cell at level
/// 0, doubled at each further level.
TileBytes build_tile(const TilePoints& points, double cell_m, const FitOptions& options);

}  // namespace holdfast::map
