#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "holdfast/core/result.hpp"
#include "holdfast/io/point_cloud.hpp"

namespace holdfast::io::clouds {

/// Reads the element "vertex" from the bytes of a PLY file (ascii, binary little or big endian);
/// other elements, such as faces, are passed over. `path` is for messages only.
Result<PointCloud> read_ply(const std::filesystem::path& path, std::string_view bytes);

/// The header of a binary little-endian PLY file with x y z (double with an origin) and intensity
/// if there is one.
std::string ply_header(const PointCloud& cloud);

}  // namespace holdfast::io::clouds
