#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/time.hpp"

/// The files of a KITTI raw drive.
namespace holdfast::io::logs {

/// The folder that holds velodyne_points: `path` or the only one below it (three levels down).
Result<std::filesystem::path> find_drive(const std::filesystem::path& path);

/// "2011-09-26 13:02:44.317412775", taken as UTC; empty if it is not of this form.
std::optional<TimeNs> parse_date_time(std::string_view text);

/// One file of a folder with numbered files, and its time.
struct TimedFile {
  std::int64_t number = 0;
  std::filesystem::path path;
  TimeNs t = 0;
};

/// Lines of a timestamps file; empty where a line is blank (a frame that was not recorded). Errors
/// name the line.
Result<std::vector<std::optional<TimeNs>>> read_timestamps(const std::filesystem::path& path);

/// The numbered files (.bin or .txt) of `folder`/data in their order, each with its time from
/// `folder`/`timestamps`. Files whose time is blank are left out; a file without a line is an
/// error.
Result<std::vector<TimedFile>> list_timed_files(const std::filesystem::path& folder,
                                                std::string_view timestamps);

/// The numbers of an OXTS file: latitude and longitude (degrees), altitude, roll, pitch, yaw, ...
inline constexpr std::size_t kOxtsValues = 25;  ///< before the five of the receiver's state
Result<std::vector<double>> read_oxts(const std::filesystem::path& path);

}  // namespace holdfast::io::logs
