#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "holdfast/core/result.hpp"
#include "holdfast/io/point_cloud.hpp"

namespace holdfast::io::clouds {

/// Reads the bytes of a PCD file of version 0.6 or 0.7: ascii, binary or binary_compressed.
/// VIEWPOINT is not applied, as in PCL. `path` is for messages only.
Result<PointCloud> read_pcd(const std::filesystem::path& path, std::string_view bytes);

/// The header of a binary PCD file with x y z (float64 with an origin) and intensity if there is
/// one.
std::string pcd_header(const PointCloud& cloud);

}  // namespace holdfast::io::clouds
