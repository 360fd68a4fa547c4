#include "holdfast/map/map_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <map>
#include <mutex>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/map/checksum.hpp"
#include "holdfast/map/fitting/tile_builder.hpp"

namespace holdfast::map {
namespace {

using TileKey = std::pair<std::int32_t, std::int32_t>;  // iy, ix: rows of tiles lie together

/// Indices of the points of each tile, in the order of the cloud.
using Buckets = std::map<TileKey, std::vector<std::uint32_t>>;

std::int32_t tile_index(double x) { return static_cast<std::int32_t>(std::floor(x / kTileSizeM)); }

/// A cloud seen from the map's origin.
struct LocalCloud {
  const io::PointCloud* cloud = nullptr;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< from the cloud's origin to the map's
  Buckets buckets;

  Eigen::Vector3d local(std::uint32_t i) const { return cloud->points[i].cast<double>() + shift; }
};

LocalCloud sort_into_tiles(const io::PointCloud& cloud, const Eigen::Vector3d& map_origin) {
  LocalCloud local{&cloud, cloud.origin - map_origin, {}};
  TileKey last_key{};
  std::vector<std::uint32_t>* last = nullptr;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d p = local.local(i);
    const TileKey key{tile_index(p.y()), tile_index(p.x())};
    if (last == nullptr || key != last_key) last = &local.buckets[key];
    last_key = key;
    last->push_back(i);
  }
  return local;
}

/// Points of a tile and its margin, relative to the tile's corner.
std::vector<Eigen::Vector3f> points_around(const LocalCloud& local, const TileKey& key,
                                           double margin) {
  const Eigen::Vector3d corner(key.second * kTileSizeM, key.first * kTileSizeM, 0);
  std::vector<Eigen::Vector3f> points;
  for (int n = 0; n < 9; ++n) {
    const auto bucket = local.buckets.find({key.first + n / 3 - 1, key.second + n % 3 - 1});
    if (bucket == local.buckets.end()) continue;
    for (const std::uint32_t i : bucket->second) {
      const Eigen::Vector3d p = local.local(i) - corner;
      if (p.x() < -margin || p.y() < -margin || p.x() > kTileSizeM + margin ||
          p.y() > kTileSizeM + margin) {
        continue;
      }
      points.push_back(p.cast<float>());
    }
  }
  return points;
}

/// The median of a list, by value.
template <class T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Side of the finest cell, a power of two: a cell on a surface holds about 4 points or more, and
/// is large against the noise, so that the layers of a smeared wall fall into one cell.
double cell_for(double spacing, double noise) {
  constexpr double kSpacings = 2.0;
  constexpr double kNoises = 10.0;
  double cell = 0.25;
  while ((cell < kSpacings * spacing || cell < kNoises * noise) && cell < 1.0) cell *= 2.0;
  return cell;
}

/// Noise of a map's points.
struct MapNoise {
  double thin_m;   ///< thickness of the thinner planes: what fits take for one plane
  double sigma_m;  ///< standard deviation that this thickness tells of
};

/// Thickness of planes, over a spread sample of the cells of a few tiles: the median over the
/// flatter half, so that foliage does not count. A sample of n points scatters about its true
/// thickness by 1 / sqrt(2 (n - 3)) of it, and the lower quartile lies 0.67 of that below.
MapNoise estimate_noise(const LocalCloud& local, double cell_m) {
  constexpr double kLeast = 0.003;
  constexpr double kMost = 0.08;
  constexpr double kQuartile = 0.674;  // of a normal distribution, in standard deviations
  const std::size_t step = std::max<std::size_t>(1, local.buckets.size() / 8);
  FitOptions narrow;
  narrow.wide_radius = narrow.narrow_radius;
  std::vector<double> thickness, sigmas;
  std::size_t number = 0;
  for (const auto& [key, indices] : local.buckets) {
    if (number++ % step != 0) continue;
    // With a margin: a wall on the border of two tiles must not be cut in two thin halves.
    const PointGrid grid(points_around(local, key, 1.0), cell_m);
    const auto& cells = grid.occupied();
    const std::size_t cell_step = std::max<std::size_t>(1, cells.size() / 200);
    for (std::size_t i = 0; i < cells.size(); i += cell_step) {
      const auto [sigma, support] = plane_thickness(grid, cells[i], narrow);
      if (support <= 0) continue;
      thickness.push_back(sigma);
      sigmas.push_back(sigma / (1.0 - kQuartile / std::sqrt(2.0 * (support - 3))));
    }
  }
  const auto quartile = [&](std::vector<double>& values) {
    if (values.empty()) return kMost;
    std::sort(values.begin(), values.end());
    return std::clamp(values[values.size() / 4], kLeast, kMost);
  };
  return {quartile(thickness), quartile(sigmas)};
}

Status write_bytes(const std::filesystem::path& path, const void* data, std::size_t bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  file.close();
  if (!file) return Error{fmt::format("{}: cannot write {} bytes", path.string(), bytes)};
  return Done{};
}

/// Everything that the tiles of one map are made from.
struct Job {
  LocalCloud cloud;
  std::optional<LocalCloud> edges;
  std::vector<TileKey> tiles;
  MapNoise noise{};
  double cell_m = 0;
  FitOptions fit;
  std::filesystem::path dir;
};

TilePoints tile_points(const Job& job, const TileKey& key) {
  TilePoints points;
  points.ix = key.second;
  points.iy = key.first;
  points.planes = points_around(job.cloud, key, tile_margin_m(job.cell_m));
  if (job.edges) {
    points.edges = points_around(*job.edges, key, tile_margin_m(job.cell_m));
    points.shared = false;
  }
  return points;
}

/// The tile's own points as they came, relative to the map's origin, for `map export`.
std::vector<Eigen::Vector3f> own_points(const Job& job, const TileKey& key) {
  std::vector<Eigen::Vector3f> points;
  for (const LocalCloud* local : {&job.cloud, job.edges ? &*job.edges : nullptr}) {
    if (local == nullptr) continue;
    const auto bucket = local->buckets.find(key);
    if (bucket == local->buckets.end()) continue;
    for (const std::uint32_t i : bucket->second) points.push_back(local->local(i).cast<float>());
  }
  return points;
}

struct TileResult {
  TileInfo info;
  std::array<std::uint64_t, kLevels> planes{};
  std::array<std::uint64_t, kLevels> lines{};
  Status status = Done{};
};

TileResult make_tile(const Job& job, const TileKey& key) {
  TileResult result;
  const TileBytes tile = build_tile(tile_points(job, key), job.cell_m, job.fit);
  const auto points = own_points(job, key);
  const std::size_t point_bytes = points.size() * sizeof(Eigen::Vector3f);
  result.info = {key.second,
                 key.first,
                 tile.bytes.size(),
                 points.size(),
                 checksum(tile.bytes.data(), tile.bytes.size()),
                 checksum(points.data(), point_bytes)};
  result.planes = tile.planes;
  result.lines = tile.lines;
  const auto stem = job.dir / result.info.stem();
  result.status = write_bytes(stem.string() + ".tile", tile.bytes.data(), tile.bytes.size());
  if (result.status.ok()) {
    result.status = write_bytes(stem.string() + ".points", points.data(), point_bytes);
  }
  return result;
}

std::vector<TileResult> make_tiles(const Job& job, WorkerPool& pool,
                                   const BuildProgress& progress) {
  std::vector<TileResult> results(job.tiles.size());
  std::mutex mutex;
  std::size_t done = 0;
  pool.run(job.tiles.size(), [&](std::size_t i) {
    results[i] = make_tile(job, job.tiles[i]);
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, job.tiles.size());
  });
  return results;
}

void set_bounds(const MapSource& source, MapInfo& info) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const io::PointCloud* cloud : {&source.cloud, source.edges ? &*source.edges : nullptr}) {
    if (cloud == nullptr) continue;
    for (const auto& p : cloud->points) {
      const Eigen::Vector3d q = p.cast<double>() + cloud->origin;
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
  }
  info.bounds_min = low;
  info.bounds_max = high;
}

/// Tiles count from a multiple of their own size near the map, so that positions inside are small.
Eigen::Vector3d origin_for(const MapInfo& info) {
  constexpr double kFar = 4096.0;
  const Eigen::Vector3d middle = 0.5 * (info.bounds_min + info.bounds_max);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(middle[axis]) > kFar) {
      origin[axis] = std::round(middle[axis] / kTileSizeM) * kTileSizeM;
    }
  }
  return origin;
}

Job plan(const MapSource& source, const MapInfo& info, const std::filesystem::path& dir) {
  Job job;
  job.cloud = sort_into_tiles(source.cloud, info.origin);
  if (source.edges) job.edges = sort_into_tiles(*source.edges, info.origin);
  job.noise = estimate_noise(job.cloud, cell_for(info.spacing_m, 0.0));
  job.fit.noise_m = job.noise.thin_m;
  job.cell_m = cell_for(info.spacing_m, job.fit.noise_m);
  job.dir = dir;
  for (const auto& [key, indices] : job.cloud.buckets) job.tiles.push_back(key);
  if (job.edges) {
    for (const auto& [key, indices] : job.edges->buckets) {
      if (!job.cloud.buckets.contains(key)) job.tiles.push_back(key);
    }
    std::sort(job.tiles.begin(), job.tiles.end());
  }
  return job;
}

Status collect(const Job& job, const std::vector<TileResult>& results, MapInfo& info) {
  info.noise_m = job.noise.sigma_m;
  for (int i = 0; i < kLevels; ++i) info.levels[i].cell_m = job.cell_m * (1 << i);
  for (const TileResult& result : results) {
    if (!result.status.ok()) return result.status.error();
    info.tiles.push_back(result.info);
    info.points += result.info.points;
    for (int i = 0; i < kLevels; ++i) {
      info.levels[i].planes += result.planes[i];
      info.levels[i].lines += result.lines[i];
    }
  }
  info.identity = identity_of(info.tiles);
  if (info.levels[0].planes + info.levels[0].lines == 0) {
    return Error{fmt::format("{}: no plane or line can be fitted to its {} points: is it a map?",
                             info.source, info.points)};
  }
  return Done{};
}

Status make_all_tiles(const MapSource& source, const std::filesystem::path& dir, WorkerPool& pool,
                      const BuildProgress& progress, MapInfo& info) {
  const Job job = plan(source, info, dir);
  return collect(job, make_tiles(job, pool, progress), info);
}

Status write_info(const std::filesystem::path& dir, const MapInfo& info) {
  return io::write_file_atomically(dir / kMapFileName, format_map_info(info));
}

}  // namespace

double estimate_spacing(const io::PointCloud& cloud) {
  constexpr double kCell = 0.5;
  constexpr double kOffset = 1 << 20;
  std::vector<std::uint64_t> keys;
  keys.reserve(cloud.points.size());
  for (const auto& p : cloud.points) {
    const Eigen::Vector3d c = (p.cast<double>() / kCell).array().floor() + kOffset;
    keys.push_back(static_cast<std::uint64_t>(c.x()) << 42 |
                   static_cast<std::uint64_t>(c.y()) << 21 | static_cast<std::uint64_t>(c.z()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> neighbours;  // of each point: how many share its cell
  neighbours.reserve(keys.size());
  for (std::size_t i = 0; i < keys.size();) {
    const auto end = std::upper_bound(keys.begin() + i, keys.end(), keys[i]) - keys.begin();
    neighbours.insert(neighbours.end(), end - i, static_cast<std::uint32_t>(end - i));
    i = static_cast<std::size_t>(end);
  }
  if (neighbours.empty()) return kCell;
  // A surface through a cell has about the area of one of its sides.
  return kCell / std::sqrt(static_cast<double>(median(std::move(neighbours))));
}

Result<MapInfo> build_map(MapSource source, const std::filesystem::path& path, WorkerPool& pool,
                          const BuildProgress& progress, const MapFinish& finish) {
  constexpr std::size_t kLeastPoints = 100;
  if (source.cloud.points.size() < kLeastPoints) {
    return Error{fmt::format("{}: {} usable points, at least {} expected", source.name,
                             source.cloud.points.size(), kLeastPoints)};
  }
  auto folder = io::AtomicFolder::create(path, kMapFileName);
  if (!folder) return folder.error();
  std::error_code failed;
  std::filesystem::create_directories(folder->staging() / "tiles", failed);
  if (failed) {
    return Error{fmt::format("{}: cannot make folder: {}", path.string(), failed.message())};
  }
  MapInfo info;
  info.source = source.name;
  set_bounds(source, info);
  info.origin = origin_for(info);
  info.spacing_m = estimate_spacing(source.cloud);
  if (auto made = make_all_tiles(source, folder->staging(), pool, progress, info); !made) {
    return made.error();
  }
  source = {};  // its memory is needed no more
  if (auto written = write_info(folder->staging(), info); !written) return written.error();
  if (finish) {
    if (auto finished = finish(folder->staging(), info); !finished) return finished.error();
    if (auto written = write_info(folder->staging(), info); !written) return written.error();
  }
  if (auto committed = folder->commit(); !committed) return committed.error();
  return info;
}

}  // namespace holdfast::map
