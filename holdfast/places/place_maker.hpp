#pragma once

#include <filesystem>

#include "holdfast/map/map_builder.hpp"
#include "holdfast/places/rendering/usual_rates.hpp"

namespace holdfast::places {

struct PlacesOptions {
  float spacing_m = 3.0F;        ///< between neighbouring places
  float sensor_height_m = 1.0F;  ///< above the floor; that of the robot's LiDAR is not known here
  ViewOptions view;
};

/// Told now and then: viewpoints done, viewpoints in all.
using PlacesProgress = map::BuildProgress;

/// Makes places of the map in `dir` and writes them to places.bin there; `info.places` then tells
/// of the file, and map.yaml is left to the caller. Viewpoints are free positions of all floors
/// that the ground leads to, with z up. A map without such positions has no places, which is no
/// error. Same map, same bytes, with any number of threads. In memory are not more than the rows of
/// tiles within reach.
Status make_places(const std::filesystem::path& dir, map::MapInfo& info,
                   const PlacesOptions& options, WorkerPool& pool,
                   const PlacesProgress& progress = {});

/// map::build_map, and the places of that map: what `holdfast map import` does.
Result<map::MapInfo> build_map(map::MapSource source, const std::filesystem::path& path,
                               WorkerPool& pool, const map::BuildProgress& tiles = {},
                               const PlacesProgress& places = {});

}  // namespace holdfast::places
