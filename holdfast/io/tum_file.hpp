#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/se3.hpp"

namespace holdfast::io {

/// Reads `t x y z qx qy qz qw` lines; '#' starts a comment. Stamps are exact to the nanosecond,
/// quaternions are normalised. Two successive lines with one stamp are kept (a teleport). Errors
/// name file and line: wrong count of numbers, not a number, zero quaternion, time that runs back.
Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path);

/// Writes a trajectory, whole or not at all: stamps with 9 decimals, poses with 9.
Status write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses);

/// One line of a TUM file, without the end of line.
std::string format_tum_line(const StampedPose& pose);

}  // namespace holdfast::io
