#pragma once

#include <filesystem>
#include <vector>

#include "holdfast/core/result.hpp"

namespace holdfast::benchmarks {

/// Reads a log from end to end and does nothing with it. Thread CPU time in ms, one value a scan:
/// its own decoding and that of the IMU readings since the scan before.
Result<std::vector<double>> time_reading(const std::filesystem::path& log);

}  // namespace holdfast::benchmarks
