#pragma once

#include <filesystem>
#include <string>

#include "holdfast/core/result.hpp"
#include "holdfast/map/map_info.hpp"

namespace holdfast::pipeline {

/// RUN/map_view.json: some tens of thousands of the map's points in the map frame, for looking at,
/// as {"points": [[x, y, z], ...]}. Reads tile by tile, so that memory stays small.
Result<std::string> map_view_json(const std::filesystem::path& map_dir, const map::MapInfo& info);

}  // namespace holdfast::pipeline
