#pragma once

#include <filesystem>

#include "holdfast/core/result.hpp"
#include "holdfast/io/point_cloud.hpp"

namespace holdfast::io {

/// Reads a point cloud by its extension: .pcd (ascii, binary, binary_compressed; any field order;
/// float32 or float64 x y z) or .ply (ascii, binary little and big endian).
/// Non-finite points are dropped and counted. Errors name the file, the place and what was
/// expected; a file that ends early, lacks x, y or z, or holds no usable point is an error.
Result<PointCloud> read_cloud(const std::filesystem::path& path);

/// Writes a cloud by its extension (.pcd: binary; .ply: binary little endian), whole or not at all.
/// A cloud with an origin is written with float64 coordinates.
Status write_cloud(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace holdfast::io
