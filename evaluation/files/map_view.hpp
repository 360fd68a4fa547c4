#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "holdfast/core/result.hpp"

namespace holdfast::evaluation {

/// A thinned-out map for looking at, as `localize` leaves it in RUN/map_view.json:
/// {"points": [[x, y, z], ...]} in metres in the map frame; other keys are ignored.
struct MapView {
  std::vector<Eigen::Vector3f> points;
};

/// More points than this are thinned out evenly.
constexpr std::size_t kMaxMapViewPoints = 60'000;

/// Errors name the file and what was expected; a point that is not three finite numbers is one.
Result<MapView> read_map_view(const std::filesystem::path& path);

}  // namespace holdfast::evaluation
