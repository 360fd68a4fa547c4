#include "holdfast/places/place_maker.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "holdfast/map/map_files.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/places/ground/standing_room.hpp"
#include "holdfast/places/ground/viewpoints.hpp"
#include "holdfast/places/places_format.hpp"

namespace holdfast::places {
namespace {

using Eigen::Vector3f;

/// A range of tiles with the same iy.
struct Row {
  std::size_t begin, end;
};

/// The rows of a map: its tiles are listed by iy, then ix.
std::vector<Row> rows_of(const std::vector<map::TileInfo>& tiles) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (i == 0 || tiles[i].iy != tiles[i - 1].iy) rows.push_back({i, i});
    rows.back().end = i + 1;
  }
  return rows;
}

/// What the places of one map are made of.
class Maker {
 public:
  Maker(const std::filesystem::path& dir, const map::MapInfo& info, const PlacesOptions& options,
        WorkerPool& pool, const PlacesProgress& progress)
      : dir_(dir),
        info_(info),
        options_(options),
        pool_(pool),
        progress_(progress),
        rows_(rows_of(info.tiles)),
        window_(dir, info) {}

  Result<std::vector<Place>> make() {
    auto map = map::PriorMap::open(dir_);
    if (!map) return map.error();
    if (auto done = find_viewpoints(); !done) return done.error();
    for (const Row& row : rows_) {
      if (!has_viewpoints(row)) continue;
      const auto loaded =
          window_.load_rows(info_.tiles[row.begin].iy, options_.view.reach_m, pool_);
      if (!loaded) return loaded.error();
      for (std::size_t tile = row.begin; tile < row.end; ++tile) {
        if (auto done = look_round(tile, *map); !done) return done.error();
      }
    }
    return std::move(places_);
  }

 private:
  Status find_viewpoints() {
    std::vector<Standing> room;
    for (const Row& row : rows_) {
      // One row more on each side: room is free or not beyond the border of a tile, too.
      if (auto loaded = window_.load_rows(info_.tiles[row.begin].iy, 1.0F, pool_); !loaded) {
        return loaded;
      }
      std::vector<std::vector<Standing>> found(row.end - row.begin);
      std::vector<Status> status(found.size(), Done{});
      pool_.run(found.size(), [&](std::size_t i) {
        auto standing =
            find_standing_room(dir_, info_.tiles[row.begin + i], info_.levels[0].cell_m, window_);
        if (standing) {
          found[i] = std::move(*standing);
        } else {
          status[i] = standing.error();
        }
      });
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (!status[i].ok()) return status[i];
        room.insert(room.end(), found[i].begin(), found[i].end());
      }
    }
    sort_into_tiles(choose_viewpoints(std::move(room), options_.spacing_m));
    return Done{};
  }

  void sort_into_tiles(const std::vector<Vector3f>& floors) {
    of_tile_.resize(info_.tiles.size());
    all_ = floors.size();
    for (const Vector3f& floor : floors) {
      const auto ix = static_cast<std::int32_t>(std::floor(floor.x() / map::kTileSizeM));
      const auto iy = static_cast<std::int32_t>(std::floor(floor.y() / map::kTileSizeM));
      const auto tile = std::lower_bound(
          info_.tiles.begin(), info_.tiles.end(), std::pair(iy, ix),
          [](const map::TileInfo& a, const auto& key) { return std::pair(a.iy, a.ix) < key; });
      of_tile_[static_cast<std::size_t>(tile - info_.tiles.begin())].push_back(
          floor + options_.sensor_height_m * Vector3f::UnitZ());
    }
  }

  bool has_viewpoints(const Row& row) const {
    return std::any_of(of_tile_.begin() + static_cast<std::ptrdiff_t>(row.begin),
                       of_tile_.begin() + static_cast<std::ptrdiff_t>(row.end),
                       [](const auto& viewpoints) { return !viewpoints.empty(); });
  }

  Status look_round(std::size_t number, map::PriorMap& map) {
    constexpr std::size_t kChunk = 4;
    const std::vector<Vector3f>& viewpoints = of_tile_[number];
    if (viewpoints.empty()) return Done{};
    const map::TileInfo& tile = info_.tiles[number];
    const Eigen::Vector3d middle =
        info_.origin + map::kTileSizeM * Eigen::Vector3d(tile.ix + 0.5, tile.iy + 0.5, 0);
    if (auto focused = map.focus(middle, options_.view.reach_m); !focused) return focused;
    std::vector<std::optional<Place>> found(viewpoints.size());
    for_each_chunk(pool_, viewpoints.size(), kChunk,
                   [&](std::size_t, std::size_t begin, std::size_t end) {
                     View view(window_, map, options_.view);
                     for (std::size_t i = begin; i < end; ++i) {
                       found[i] = view.from(viewpoints[i], tile.ix, tile.iy, done_ + i);
                     }
                   });
    for (const auto& place : found) {
      if (place) places_.push_back(*place);
    }
    done_ += viewpoints.size();
    if (progress_) progress_(done_, all_);
    return Done{};
  }

  const std::filesystem::path& dir_;
  const map::MapInfo& info_;
  const PlacesOptions& options_;
  WorkerPool& pool_;
  const PlacesProgress& progress_;
  std::vector<Row> rows_;
  VoxelWindow window_;
  std::vector<std::vector<Vector3f>> of_tile_;  // viewpoints
  std::vector<Place> places_;
  std::size_t done_ = 0;
  std::size_t all_ = 0;
};

std::vector<std::byte> bytes_of(const std::vector<Place>& places) {
  PlacesHeader header;
  header.count = static_cast<std::uint32_t>(places.size());
  std::vector<std::byte> bytes(sizeof(header) + places.size() * sizeof(Place));
  std::memcpy(bytes.data(), &header, sizeof(header));
  if (!places.empty()) {
    std::memcpy(bytes.data() + sizeof(header), places.data(), places.size() * sizeof(Place));
  }
  return bytes;
}

}  // namespace

Status make_places(const std::filesystem::path& dir, map::MapInfo& info,
                   const PlacesOptions& options, WorkerPool& pool, const PlacesProgress& progress) {
  const auto places = Maker(dir, info, options, pool, progress).make();
  if (!places) return places.error();
  const auto written = map::write_summed(dir / map::kPlacesFileName, bytes_of(*places));
  if (!written) return written.error();
  info.places = *written;
  return Done{};
}

Result<map::MapInfo> build_map(map::MapSource source, const std::filesystem::path& path,
                               WorkerPool& pool, const map::BuildProgress& tiles,
                               const PlacesProgress& places) {
  const auto add_places = [&](const std::filesystem::path& dir, map::MapInfo& info) {
    return make_places(dir, info, PlacesOptions{}, pool, places);
  };
  return map::build_map(std::move(source), path, pool, tiles, add_places);
}

}  // namespace holdfast::places
