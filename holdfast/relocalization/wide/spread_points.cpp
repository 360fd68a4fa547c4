#include "holdfast/relocalization/wide/spread_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace holdfast::relocalization {
namespace {

using Eigen::Vector3f;

constexpr float kCellM = 0.5F;
constexpr float kUprightM = 0.35F;  // of points above each other in one column
constexpr std::size_t kSectors = 60;

/// A point with the column and the cell that it is in.
struct Located {
  int x, y, z;
  Vector3f p;
};

std::vector<Located> locate(const std::vector<Vector3f>& points, const SpreadOptions& options) {
  std::vector<Located> located;
  located.reserve(points.size());
  const auto cell = [](float v) { return static_cast<int>(std::floor(v / kCellM)); };
  for (const Vector3f& p : points) {
    const float range = p.norm();
    if (!(range >= options.nearest_m && range <= options.reach_m)) continue;
    located.push_back({cell(p.x()), cell(p.y()), cell(p.z()), p});
  }
  std::stable_sort(located.begin(), located.end(), [](const Located& a, const Located& b) {
    if (a.y != b.y) return a.y < b.y;
    if (a.x != b.x) return a.x < b.x;
    return a.z < b.z;
  });
  return located;
}

std::size_t sector_of(const Vector3f& p) {
  const float turn = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi_v<float>)+0.5F;
  return std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors));
}

using Sectors = std::array<std::vector<Vector3f>, kSectors>;

/// The middle one of each cell's points, into the sectors of upright or flat things.
void sort_into_sectors(const std::vector<Located>& located, Sectors& upright, Sectors& flat) {
  for (std::size_t begin = 0, end = 0; begin < located.size(); begin = end) {
    float low = located[begin].p.z(), high = low;
    for (; end < located.size() && located[end].x == located[begin].x &&
           located[end].y == located[begin].y;
         ++end) {
      low = std::min(low, located[end].p.z());
      high = std::max(high, located[end].p.z());
    }
    Sectors& sectors = high - low > kUprightM ? upright : flat;
    for (std::size_t first = begin, last = begin; first < end; first = last) {
      while (last < end && located[last].z == located[first].z) ++last;
      const Vector3f& p = located[first + (last - first) / 2].p;
      sectors[sector_of(p)].push_back(p);
    }
  }
}

/// Takes from all sectors in turn, of each at places spread over what it has.
void take(const Sectors& sectors, std::size_t most, std::vector<Vector3f>& chosen) {
  constexpr double kGolden = 0.6180339887498949;
  const std::size_t end = chosen.size() + most;
  std::array<std::vector<std::uint8_t>, kSectors> taken;
  for (std::size_t s = 0; s < kSectors; ++s) taken[s].assign(sectors[s].size(), 0);
  for (std::size_t round = 0; chosen.size() < end; ++round) {
    bool any = false;
    for (std::size_t k = 0; k < kSectors && chosen.size() < end; ++k) {
      const std::size_t s = k * 23 % kSectors;  // neighbours not one after the other
      if (round >= sectors[s].size()) continue;
      const double u = kGolden * static_cast<double>(round + 1);
      auto i =
          static_cast<std::size_t>((u - std::floor(u)) * static_cast<double>(sectors[s].size()));
      while (taken[s][i] != 0) i = (i + 1) % sectors[s].size();
      taken[s][i] = 1;
      chosen.push_back(sectors[s][i]);
      any = true;
    }
    if (!any) break;
  }
}

}  // namespace

std::vector<Vector3f> spread_points(const std::vector<Vector3f>& points,
                                    const SpreadOptions& options) {
  Sectors upright, flat;
  sort_into_sectors(locate(points, options), upright, flat);
  std::vector<Vector3f> chosen, level;
  const auto most = static_cast<std::size_t>(options.points);
  take(flat, static_cast<std::size_t>(options.flat_share * static_cast<float>(most)), level);
  take(upright, most - level.size(), chosen);
  // Where little is upright, floors are not all that is seen.
  const std::size_t flat_most = static_cast<std::size_t>(
      options.flat_share / (1.0F - options.flat_share) * static_cast<float>(chosen.size()));
  level.resize(std::min(level.size(), flat_most));
  std::vector<Vector3f> mixed;
  for (std::size_t i = 0, l = 0; i < chosen.size(); ++i) {
    mixed.push_back(chosen[i]);
    while (l < level.size() && l * chosen.size() <= i * level.size()) mixed.push_back(level[l++]);
  }
  return mixed;
}

}  // namespace holdfast::relocalization
