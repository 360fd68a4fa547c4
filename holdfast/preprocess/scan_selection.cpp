#include "holdfast/preprocess/scan_selection.hpp"

#include <algorithm>

namespace holdfast::preprocess {
namespace {

/// A cheap integer hash (Murmur3's finaliser).
std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x85ebca6bU;
  x = (x ^ (x >> 13)) * 0xc2b2ae35U;
  return x ^ (x >> 16);
}

/// Keeps one of each run of values[0, n): `most` values remain.
void thin(std::vector<std::uint32_t>& values, std::uint64_t most, std::uint64_t scan_number) {
  const std::uint64_t n = values.size();
  const auto salt = static_cast<std::uint32_t>(scan_number * 0x9e3779b9ULL);
  for (std::uint64_t k = 0; k < most; ++k) {
    const std::uint64_t begin = k * n / most;
    const std::uint64_t length = (k + 1) * n / most - begin;
    const std::uint64_t place = scramble(static_cast<std::uint32_t>(k) + salt) % length;
    values[k] = values[begin + place];
  }
  values.resize(most);
}

}  // namespace

std::size_t select_points(const Scan& scan, const ScanSelectionConfig& config,
                          std::uint64_t scan_number, std::vector<std::uint32_t>& out) {
  const auto low = static_cast<float>(config.min_range_m * config.min_range_m);
  const auto high = static_cast<float>(config.max_range_m * config.max_range_m);
  out.resize(scan.points.size());
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    const float range_sq = p.x * p.x + p.y * p.y + p.z * p.z;
    out[count] = i;
    count += static_cast<std::size_t>((range_sq >= low) & (range_sq <= high));
  }
  out.resize(count);
  const auto share = static_cast<std::size_t>(config.least_share * static_cast<double>(count));
  const auto most = std::max(static_cast<std::size_t>(std::max(config.max_points, 1)), share);
  if (count > most) thin(out, most, scan_number);
  return count;
}

}  // namespace holdfast::preprocess
