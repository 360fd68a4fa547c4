#include "holdfast/io/log_file.hpp"

#include <new>
#include <stdexcept>

#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/logs/bag_log.hpp"
#include "holdfast/io/logs/kitti_log.hpp"

namespace holdfast::io {
namespace {

using files::error_at;

Result<std::unique_ptr<LogReader>> open_by_kind(const std::filesystem::path& path,
                                                const LogOptions& options) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return error_at(path, "does not exist");
  if (std::filesystem::is_directory(status)) return logs::open_kitti_log(path, options);
  // A recording that was cut off keeps the name it had while it was made.
  if (path.extension() == ".bag" || path.extension() == ".active") {
    return logs::open_bag_log(path, options);
  }
  return error_at(path,
                  "extension '{}' is not one of a log, expected a ROS 1 bag (.bag) or the "
                  "folder of a KITTI raw drive",
                  path.extension().string());
}

}  // namespace

Result<std::unique_ptr<LogReader>> open_log(const std::filesystem::path& path,
                                            const LogOptions& options) {
  try {
    return open_by_kind(path, options);
  } catch (const std::bad_alloc&) {
    return error_at(path, "does not fit into memory");
  } catch (const std::length_error&) {
    return error_at(path, "does not fit into memory");
  }
}

}  // namespace holdfast::io
