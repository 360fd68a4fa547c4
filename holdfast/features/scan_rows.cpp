#include "holdfast/features/scan_rows.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

namespace holdfast::features {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr int kElevationBins = 2048;  // over the sine of the elevation, 0.06 degrees at the horizon
constexpr int kAzimuthBins = 8192;

float elevation_sine(const Eigen::Vector3f& p) {
  const float range_sq = p.squaredNorm();
  return range_sq > 0 ? p.z() / std::sqrt(range_sq) : 0.0F;
}

/// Grows with the azimuth from 0 to 4 over a full turn from the negative x axis.
float diamond_angle(const Eigen::Vector3f& p) {
  const float sum = std::abs(p.x()) + std::abs(p.y());
  if (sum <= 0) return 0.0F;
  const float along = p.x() / sum;
  return p.y() < 0 ? 1.0F + along : 3.0F - along;
}

/// Places in the order of points at which the azimuth passes an axis.
struct Passes {
  std::size_t up = 0, down = 0;  ///< by sense
  double elevation_step = 0;     ///< sum of the changes of elevation there

  std::size_t most() const { return std::max(up, down); }
  /// As a sensor does that goes round and round.
  bool steady() const { return most() >= 4 && std::min(up, down) * 10 <= most(); }
};

/// True where points[i - 1] and points[i] lie on either side of the positive (front) or negative x
/// axis.
bool passes(const Points& points, std::size_t i, bool front) {
  const bool above = points[i].y() >= 0;
  return above != (points[i - 1].y() >= 0) && (points[i].x() > 0) == front;
}

Passes passes_of(const Points& points, bool front) {
  Passes found;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!passes(points, i, front)) continue;
    ++(points[i].y() >= 0 ? found.up : found.down);
    found.elevation_step += std::abs(elevation_sine(points[i]) - elevation_sine(points[i - 1]));
  }
  return found;
}

}  // namespace

void RowSorter::sort(const Scan& scan, ScanRows& out) {
  points_.resize(scan.points.size());
  row_of_.resize(scan.has_ring ? scan.points.size() : 0);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    points_[i] = {p.x, p.y, p.z};
    if (scan.has_ring) row_of_[i] = p.ring;
  }
  if (!scan.has_ring) return sort(points_, {}, out);
  order_.resize(points_.size());
  std::iota(order_.begin(), order_.end(), 0U);
  out.regular = true;
  distribute(points_, out);
}

void RowSorter::sort(const Points& points, const std::vector<std::uint16_t>& rings, ScanRows& out) {
  assert(rings.empty() || rings.size() == points.size());
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0U);
  out.regular = true;
  if (!rings.empty()) {
    row_of_ = rings;
  } else if (!find_turns(points)) {
    count_elevations(points);
    out.regular = find_beams();
    if (!out.regular) lay_grid();
    rows_from_bins();
    order_by_azimuth(points);
  }
  distribute(points, out);
}

/// A sensor's log may hold one ring after the other. A ring begins where its elevation jumps: at
/// the front or at the back.
bool RowSorter::find_turns(const Points& points) {
  const Passes front = passes_of(points, true);
  const Passes back = passes_of(points, false);
  if (!front.steady() || !back.steady()) return false;
  const bool at_front = front.elevation_step > back.elevation_step;
  const std::size_t turns = (at_front ? front : back).most() + 1;
  if (turns > 512 || points.size() / turns < 30) return false;
  row_of_.resize(points.size());
  std::uint16_t row = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && passes(points, i, at_front)) ++row;
    row_of_[i] = row;
  }
  if (elevation_sine(points.front()) > elevation_sine(points.back())) {
    for (std::uint16_t& r : row_of_) r = static_cast<std::uint16_t>(row - r);
  }
  return true;
}

void RowSorter::count_elevations(const Points& points) {
  bin_of_.resize(points.size());
  in_bin_.assign(kElevationBins, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int bin = static_cast<int>((elevation_sine(points[i]) + 1.0F) * (0.5F * kElevationBins));
    bin_of_[i] = static_cast<std::uint16_t>(std::clamp(bin, 0, kElevationBins - 1));
    ++in_bin_[bin_of_[i]];
  }
}

/// Beams stand apart: runs of occupied bins, few bins wide, with empty ones between them.
bool RowSorter::find_beams() {
  bin_row_.assign(kElevationBins, 0);
  int runs = 0, occupied = 0;
  for (int bin = 0; bin < kElevationBins; ++bin) {
    if (in_bin_[bin] == 0) continue;
    if (bin == 0 || in_bin_[bin - 1] == 0) ++runs;
    bin_row_[bin] = static_cast<std::uint16_t>(runs - 1);
    ++occupied;
  }
  return runs >= 2 && runs <= 512 && occupied <= 3 * runs;
}

/// Rows about twice as high as the points are apart, if they are spread evenly over the field.
void RowSorter::lay_grid() {
  const auto occupied = static_cast<double>(
      std::count_if(in_bin_.begin(), in_bin_.end(), [](std::uint32_t n) { return n > 0; }));
  const double field = 2.0 * M_PI * occupied * 2.0 / kElevationBins;  // steradian
  const double apart =
      std::sqrt(field / static_cast<double>(std::max<std::size_t>(bin_of_.size(), 1)));
  const int height = std::max(1, static_cast<int>(2.0 * apart * kElevationBins / 2.0));
  for (int bin = 0; bin < kElevationBins; ++bin) {
    bin_row_[bin] = static_cast<std::uint16_t>(bin / height);
  }
}

void RowSorter::rows_from_bins() {
  row_of_.resize(bin_of_.size());
  for (std::size_t i = 0; i < bin_of_.size(); ++i) row_of_[i] = bin_row_[bin_of_[i]];
}

void RowSorter::order_by_azimuth(const Points& points) {
  const auto bin_of = [](const Eigen::Vector3f& p) {
    return std::min(static_cast<std::size_t>(diamond_angle(p) * (0.25F * kAzimuthBins)),
                    static_cast<std::size_t>(kAzimuthBins - 1));
  };
  fill_.assign(kAzimuthBins + 1, 0);
  for (const auto& p : points) ++fill_[bin_of(p) + 1];
  std::partial_sum(fill_.begin(), fill_.end(), fill_.begin());
  for (std::uint32_t i = 0; i < points.size(); ++i) order_[fill_[bin_of(points[i])]++] = i;
}

void RowSorter::distribute(const Points& points, ScanRows& out) {
  const std::uint16_t highest =
      row_of_.empty() ? std::uint16_t{0} : *std::max_element(row_of_.begin(), row_of_.end());
  out.begin.assign(points.empty() ? 0 : highest + 2U, 0);
  out.points.resize(points.size());
  out.source.resize(points.size());
  if (points.empty()) return;
  for (const std::uint16_t row : row_of_) ++out.begin[row + 1U];
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  fill_.assign(out.begin.begin(), out.begin.end());
  for (const std::uint32_t i : order_) {
    const std::uint32_t at = fill_[row_of_[i]]++;
    out.points[at] = points[i];
    out.source[at] = i;
  }
}

}  // namespace holdfast::features
