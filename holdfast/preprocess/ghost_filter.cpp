#include "holdfast/preprocess/ghost_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace holdfast::preprocess {
namespace {

constexpr std::size_t kBins = 1024;  // of azimuth
constexpr std::size_t kAround = 8;   // points looked at on each side of a place in another ring
constexpr float kWide = 4.0F;        // azimuth of company in another ring, in spots

/// Grows with the azimuth over a turn.
std::size_t azimuth_bin(const Eigen::Vector3f& ray) {
  const float along = ray.x() / (std::abs(ray.x()) + std::abs(ray.y()) + 1e-12F);
  const float turn = ray.y() < 0 ? 1.0F + along : 3.0F - along;
  return std::min(static_cast<std::size_t>(turn * (0.25F * kBins)), kBins - 1);
}

}  // namespace

GhostFilter::GhostFilter(const GhostFilterConfig& config)
    : config_(config),
      spot_cosine_(static_cast<float>(std::cos(1e-3 * config.spot_mrad))),
      apart_(static_cast<float>(config.apart_m)) {}

void GhostFilter::sort_rows(const Scan& scan) {
  std::size_t rows = 0;
  for (const ScanPoint& p : scan.points) rows = std::max<std::size_t>(rows, p.ring + 1U);
  begin_.assign(rows + 1, 0);
  for (const ScanPoint& p : scan.points) ++begin_[p.ring + 1U];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  fill_.assign(begin_.begin(), begin_.end());
  rays_.resize(scan.points.size());
  ranges_.resize(scan.points.size());
  source_.resize(scan.points.size());
  for (std::uint32_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    const std::uint32_t at = fill_[p.ring]++;
    const Eigen::Vector3f q(p.x, p.y, p.z);
    ranges_[at] = q.norm();
    rays_[at] = q / std::max(ranges_[at], 1e-6F);
    source_[at] = i;
  }
}

void GhostFilter::fill_table() {
  const std::size_t rows = begin_.size() - 1;
  table_.assign(rows * kBins, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::uint32_t at = begin_[row]; at < begin_[row + 1]; ++at) {
      table_[row * kBins + azimuth_bin(rays_[at])] = at + 1;
    }
  }
}

/// By its neighbours along the ring alone. `at` has two on each side: where these are not on one
/// surface themselves, as on a wall seen at grazing incidence or in leaves, nothing is said.
GhostFilter::Kind GhostFilter::kind_of(std::size_t at) const {
  const float before = ranges_[at - 1], here = ranges_[at], after = ranges_[at + 1];
  const float nearer = std::min(before, after);
  const float farther = std::max(before, after);
  const bool between = here - nearer > apart_ && farther - here > apart_;
  const bool behind = here - farther > apart_ && farther - nearer < apart_;
  if (!(between && config_.mixed_pixels) && !(behind && config_.ghosts)) return Kind::kGood;
  if (rays_[at].dot(rays_[at - 1]) < spot_cosine_ || rays_[at].dot(rays_[at + 1]) < spot_cosine_) {
    return Kind::kGood;  // they share no spot
  }
  if (std::abs(ranges_[at - 2] - before) > apart_ || std::abs(ranges_[at + 2] - after) > apart_) {
    return Kind::kGood;
  }
  return between ? Kind::kMixed : Kind::kGhost;
}

/// True when a ray of `row` close to the azimuth of the point met something at about its range.
bool GhostFilter::is_near(std::size_t row, std::size_t at) const {
  const Eigen::Vector2f ray = rays_[at].head<2>().normalized();
  const float wide = kWide * std::acos(spot_cosine_);
  const std::size_t bin = azimuth_bin(rays_[at]);
  for (const std::size_t b : {bin, (bin + 1) % kBins, (bin + kBins - 1) % kBins}) {
    const std::size_t found = table_[row * kBins + b];
    if (found == 0) continue;
    const std::size_t first = std::max<std::size_t>(begin_[row] + kAround, found - 1) - kAround;
    const std::size_t last = std::min<std::size_t>(begin_[row + 1], found + kAround);
    for (std::size_t k = first; k < last; ++k) {
      const Eigen::Vector2f other = rays_[k].head<2>().normalized();
      const float turn = std::abs(ray.x() * other.y() - ray.y() * other.x());
      if (turn < wide && std::abs(ranges_[k] - ranges_[at]) < apart_) return true;
    }
  }
  return false;
}

bool GhostFilter::has_company(std::size_t row, std::size_t at) const {
  const std::size_t rows = begin_.size() - 1;
  return (row > 0 && is_near(row - 1, at)) || (row + 1 < rows && is_near(row + 1, at));
}

GhostCounts GhostFilter::apply(Scan& scan) {
  GhostCounts counts;
  if ((!config_.mixed_pixels && !config_.ghosts) || !scan.has_ring) return counts;
  sort_rows(scan);
  kinds_.assign(scan.points.size(), Kind::kGood);
  bool table = false;
  for (std::size_t row = 0; row + 1 < begin_.size(); ++row) {
    for (std::size_t at = begin_[row] + 2U; at + 2 < begin_[row + 1]; ++at) {
      const Kind kind = kind_of(at);
      if (kind == Kind::kGood) continue;
      if (!table) fill_table();
      table = true;
      if (has_company(row, at)) continue;
      kinds_[source_[at]] = kind;
      ++(kind == Kind::kMixed ? counts.mixed_pixels : counts.ghosts);
    }
  }
  if (counts.mixed_pixels + counts.ghosts == 0) return counts;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (kinds_[i] == Kind::kGood) scan.points[kept++] = scan.points[i];
  }
  scan.points.resize(kept);
  return counts;
}

}  // namespace holdfast::preprocess
