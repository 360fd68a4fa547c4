#include "holdfast/io/cloud_file.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <new>
#include <stdexcept>
#include <string>

#include "holdfast/io/clouds/pcd_file.hpp"
#include "holdfast/io/clouds/ply_file.hpp"
#include "holdfast/io/files/bytes.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/mapped_file.hpp"
#include "holdfast/io/files/staged_file.hpp"

namespace holdfast::io {
namespace {

using files::error_at;

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Error unknown_extension(const std::filesystem::path& path) {
  return error_at(path, "extension '{}' is not one of a point cloud, expected .pcd or .ply",
                  path.extension().string());
}

Result<PointCloud> read_by_extension(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension != ".pcd" && extension != ".ply") return unknown_extension(path);
  const auto file = files::MappedFile::open(path);
  if (!file) return file.error();
  auto cloud = extension == ".pcd" ? clouds::read_pcd(path, file->bytes())
                                   : clouds::read_ply(path, file->bytes());
  if (cloud && cloud->points.empty()) {
    return error_at(path, "holds no usable point ({} are not finite)", cloud->invalid_points);
  }
  return cloud;
}

void append_point(const PointCloud& cloud, std::size_t i, bool far, std::string& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const float value = cloud.points[i][axis];
    if (far)
      files::append(out, cloud.origin[axis] + static_cast<double>(value));
    else
      files::append(out, value);
  }
  if (!cloud.intensity.empty()) files::append(out, cloud.intensity[i]);
}

}  // namespace

Result<PointCloud> read_cloud(const std::filesystem::path& path) {
  try {
    return read_by_extension(path);
  } catch (const std::bad_alloc&) {
    return error_at(path, "does not fit into memory");
  } catch (const std::length_error&) {
    return error_at(path, "does not fit into memory");
  }
}

Status write_cloud(const std::filesystem::path& path, const PointCloud& cloud) {
  assert(cloud.intensity.empty() || cloud.intensity.size() == cloud.points.size());
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  const std::string extension = lower_extension(path);
  if (extension != ".pcd" && extension != ".ply") return unknown_extension(path);
  auto file = files::StagedFile::create(path);
  if (!file) return file.error();
  std::string block = extension == ".pcd" ? clouds::pcd_header(cloud) : clouds::ply_header(cloud);
  const bool far = !cloud.origin.isZero(0);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    append_point(cloud, i, far, block);
    if (block.size() < kBlockBytes) continue;
    auto status = file->write(block);
    if (!status) return status;
    block.clear();
  }
  auto status = file->write(block);
  return status ? file->commit() : status;
}

}  // namespace holdfast::io
