#include "holdfast/map/fitting/tile_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "holdfast/map/fitting/adopted_planes.hpp"
#include "holdfast/map/fitting/closed_planes.hpp"
#include "holdfast/map/fitting/surface_grid.hpp"

namespace holdfast::map {
namespace {

/// One level while it is built.
struct Level {
  LevelHeader header{};
  std::vector<std::uint32_t> index;
  std::vector<std::uint32_t> blocks;
  std::vector<Surface> surfaces;
};

/// Every 2^level-th point: a coarser level needs fewer points for fits of the same support.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, int level) {
  std::vector<Eigen::Vector3f> kept;
  const std::size_t step = std::size_t{1} << level;
  kept.reserve(points.size() / step + 1);
  for (std::size_t i = 0; i < points.size(); i += step) kept.push_back(points[i]);
  return kept;
}

/// Distance from the middle of a cell to the disc-shaped piece of surface of a neighbour.
double borrow_distance(const Surface& s, const Eigen::Vector3f& middle, double cell_m) {
  const Eigen::Vector3f d = middle - s.center;
  const double along_normal = std::abs(s.normal.dot(d));
  const double lateral = std::sqrt(std::max(0.0, d.squaredNorm() - along_normal * along_normal));
  if (s.kind == SurfaceKind::kClutter) return std::numeric_limits<double>::infinity();
  if (s.kind == SurfaceKind::kLine) return lateral + cell_m;  // planes first
  return std::hypot(along_normal, std::max(0.0, lateral - cell_m));
}

/// A thin plane beside a parallel one with many times its support: a smeared copy of the same wall.
bool is_ghost_of(const Surface& weak, const Surface& strong, double cell_m) {
  constexpr int kTimesTheSupport = 4;
  return strong.support >= kTimesTheSupport * weak.support &&
         std::abs(weak.normal.dot(strong.normal)) > 0.9F &&
         std::abs(strong.normal.dot(weak.center - strong.center)) < 1.5 * cell_m;
}

bool is_ghost(SurfaceGrid& grid, const std::vector<Surface>& surfaces, const Cell& cell,
              const Surface& surface) {
  for (int n = 0; n < 27; ++n) {
    const Cell c = cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    if (!grid.covers(c) || grid.first(c) == 0) continue;
    for (std::uint32_t i = grid.first(c);; ++i) {
      if (is_ghost_of(surface, surfaces[i - 1], grid.cell_m())) return true;
      if (surfaces[i - 1].more == 0) break;
    }
  }
  return false;
}

/// Takes out the cells whose only plane is a ghost; they will borrow the true one.
void drop_ghosts(SurfaceGrid& grid, const std::vector<Surface>& surfaces,
                 std::vector<Cell>& fitted) {
  std::vector<Cell> ghosts;
  for (const Cell& cell : fitted) {
    const Surface& s = surfaces[grid.first(cell) - 1];
    if (s.more == 0 && s.kind == SurfaceKind::kPlane && is_ghost(grid, surfaces, cell, s)) {
      ghosts.push_back(cell);
    }
  }
  for (const Cell& cell : ghosts) grid.first(cell) = 0;
}

/// First surface of the neighbour that a surface nearest to an empty cell belongs to. All of that
/// neighbour's surfaces are borrowed, so that a point can tell which of them it is nearest to.
std::uint32_t borrowed(SurfaceGrid& grid, const std::vector<Surface>& surfaces, const Cell& cell) {
  const Eigen::Vector3f middle =
      ((cell.cast<double>().array() + 0.5) * grid.cell_m()).matrix().cast<float>();
  std::uint32_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 27; ++n) {
    const Cell c = cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    if (!grid.covers(c) || grid.first(c) == 0) continue;
    const std::uint32_t first = grid.first(c);
    for (std::uint32_t i = first;; ++i) {
      const double distance = borrow_distance(surfaces[i - 1], middle, grid.cell_m());
      if (distance < best_distance) {
        best_distance = distance;
        best = first;
      }
      if (surfaces[i - 1].more == 0) break;
    }
  }
  return best;
}

int block_of(int cell) { return cell >> 3; }

/// Space for the blocks that are within one cell of an occupied one.
void lay_out_blocks(const std::vector<Cell>& occupied, Level& level) {
  const int cells_xy = static_cast<int>(kTileSizeM / level.header.cell_m);
  int low = std::numeric_limits<int>::max();
  int high = std::numeric_limits<int>::min();
  for (const Cell& c : occupied) {
    low = std::min(low, c.z() - 1);
    high = std::max(high, c.z() + 1);
  }
  level.header.blocks_xy = (cells_xy + kBlockCells - 1) / kBlockCells;
  if (occupied.empty()) return;
  level.header.z_block = block_of(low);
  level.header.blocks_z = block_of(high) - block_of(low) + 1;
  const int n = level.header.blocks_xy;
  level.index.assign(static_cast<std::size_t>(n) * n * level.header.blocks_z, 0);
  for (const Cell& cell : occupied) {
    for (int k = 0; k < 27; ++k) {
      const Cell c = cell + Cell(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (c.x() < 0 || c.y() < 0 || c.x() >= cells_xy || c.y() >= cells_xy) continue;
      const int bz = block_of(c.z()) - level.header.z_block;
      auto& slot = level.index[(bz * n + block_of(c.y())) * n + block_of(c.x())];
      if (slot == 0) slot = ++level.header.block_count;
    }
  }
  level.blocks.assign(static_cast<std::size_t>(level.header.block_count) * kCellsPerBlock, 0);
}

void fill_blocks(SurfaceGrid& grid, Level& level) {
  const int n = level.header.blocks_xy;
  const int cells_xy = static_cast<int>(kTileSizeM / level.header.cell_m);
  for (std::size_t slot = 0; slot < level.index.size(); ++slot) {
    if (level.index[slot] == 0) continue;
    const Cell corner(static_cast<int>(slot) % n, static_cast<int>(slot) / n % n,
                      static_cast<int>(slot) / (n * n) + level.header.z_block);
    std::uint32_t* block = &level.blocks[(level.index[slot] - 1) * kCellsPerBlock];
    for (int i = 0; i < kCellsPerBlock; ++i) {
      const Cell c = corner * kBlockCells + Cell(i & 7, i >> 3 & 7, i >> 6);
      if (c.x() >= cells_xy || c.y() >= cells_xy) continue;
      const std::uint32_t own = grid.covers(c) ? grid.first(c) : 0;
      block[i] = own != 0 ? own : borrowed(grid, level.surfaces, c);
    }
  }
}

/// Fits the surfaces of all cells of the tile, and of the ring of cells around it. Cells whose only
/// plane is a ghost are left empty.
SurfaceGrid fit_level(const TilePoints& points, double cell_m, int level, const FitOptions& options,
                      std::vector<Cell>& fitted, std::vector<Surface>& surfaces) {
  const PointGrid planes(thinned(points.planes, level), cell_m);
  const PointGrid edges(thinned(points.edges, level), cell_m);
  int z_low = 0;
  int z_high = 0;
  for (const auto* grid : {&planes, &edges}) {
    if (grid->occupied().empty()) continue;
    z_low = std::min(z_low, grid->occupied().front().z());
    z_high = std::max(z_high, grid->occupied().back().z());
  }
  SurfaceGrid result(cell_m, z_low, z_high);
  const auto fit_all = [&](const PointGrid& grid, const FitOptions& fit) {
    for (const Cell& cell : grid.occupied()) {
      if (!result.covers(cell) || result.first(cell) != 0) continue;
      const std::size_t before = surfaces.size();
      fit_cell(grid, cell, fit, surfaces);
      if (surfaces.size() == before) continue;
      result.first(cell) = static_cast<std::uint32_t>(before + 1);
      fitted.push_back(cell);
    }
  };
  FitOptions plane_fit = options;
  plane_fit.lines = options.lines && points.shared;
  fit_all(planes, plane_fit);
  FitOptions line_fit = options;
  line_fit.planes = false;
  if (!points.shared) fit_all(edges, line_fit);
  drop_ghosts(result, surfaces, fitted);
  mark_closed_planes(planes, options, fitted, result, surfaces);
  adopt_planes(planes, options, fitted, result, surfaces);
  return result;
}

Level build_level(const TilePoints& points, double cell_m, int number, const FitOptions& options) {
  Level level;
  level.header.cell_m = static_cast<float>(cell_m);
  std::vector<Cell> fitted;
  SurfaceGrid grid = fit_level(points, cell_m, number, options, fitted, level.surfaces);
  lay_out_blocks(fitted, level);
  fill_blocks(grid, level);
  level.header.surface_count = static_cast<std::uint32_t>(level.surfaces.size());
  return level;
}

template <class T>
std::uint64_t append(std::vector<std::byte>& bytes, const std::vector<T>& values) {
  const std::size_t offset = bytes.size();
  bytes.resize(offset + values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data() + offset, values.data(), values.size() * sizeof(T));
  return offset;
}

void append_level(Level& level, std::vector<std::byte>& bytes) {
  level.header.index_offset = append(bytes, level.index);
  level.header.blocks_offset = append(bytes, level.blocks);
  level.header.surfaces_offset = append(bytes, level.surfaces);
}

}  // namespace

double tile_margin_m(double cell_m) {
  // The ring of one coarsest cell, and the wide neighbourhood of a point in it.
  const double coarsest = cell_m * (1 << (kLevels - 1));
  return coarsest * (1.0 + FitOptions{}.wide_radius);
}

TileBytes build_tile(const TilePoints& points, double cell_m, const FitOptions& options) {
  TileBytes result;
  TileHeader header{};
  header.magic = kTileMagic;
  header.version = kTileVersion;
  header.ix = points.ix;
  header.iy = points.iy;
  result.bytes.resize(sizeof(TileHeader));
  for (int i = 0; i < kLevels; ++i) {
    Level level = build_level(points, cell_m * (1 << i), i, options);
    append_level(level, result.bytes);
    header.levels[i] = level.header;
    for (const Surface& s : level.surfaces) {
      result.planes[i] += s.kind == SurfaceKind::kPlane ? 1 : 0;
      result.lines[i] += s.kind == SurfaceKind::kLine ? 1 : 0;
    }
  }
  header.file_size = result.bytes.size();
  std::memcpy(result.bytes.data(), &header, sizeof(header));
  return result;
}

}  // namespace holdfast::map
