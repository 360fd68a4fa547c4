#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/files/map_view.hpp"

namespace holdfast::evaluation {

/// Points for the page: {"count", "min": [x, y, z], "step": [x, y, z], "xyz": base64 of uint16,
/// little endian, x0 y0 z0 x1 ...}; a coordinate is min + step * integer. Steps are 1/65535 of the
/// extent (1.3 cm at 850 m), far below a pixel.
nlohmann::ordered_json map_points_json(const MapView& map);

}  // namespace holdfast::evaluation
