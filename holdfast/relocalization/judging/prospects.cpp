#include "holdfast/relocalization/judging/prospects.hpp"

#include <algorithm>
#include <numbers>

namespace holdfast::relocalization {
namespace {

constexpr double kSameM = 0.3;
constexpr double kSameRad = 3.0 * std::numbers::pi / 180.0;
constexpr double kFarthestM = 1.5;

}  // namespace

bool same_pose(const SE3& a, const SE3& b) {
  return (a.translation - b.translation).norm() < kSameM &&
         so3::angle_between(a.rotation, b.rotation) < kSameRad;
}

bool Prospect::leads_to(const SE3& refined) const {
  return (refined.translation - T_map_body.translation).norm() <= kFarthestM;
}

void Prospect::take(const Refined& refined) {
  rough = refined.T_map_body;
  share = refined.usable && leads_to(rough) ? refined.agreeing_share : 0;
}

void keep_best(std::size_t most, std::vector<Prospect>& prospects) {
  std::stable_sort(prospects.begin(), prospects.end(),
                   [](const Prospect& a, const Prospect& b) { return a.share > b.share; });
  std::vector<Prospect> kept;
  for (const Prospect& prospect : prospects) {
    if (prospect.share <= 0 || kept.size() >= most) break;
    const bool copy = std::any_of(kept.begin(), kept.end(), [&](const Prospect& other) {
      return same_pose(prospect.rough, other.rough);
    });
    if (!copy) kept.push_back(prospect);
  }
  prospects = std::move(kept);
}

}  // namespace holdfast::relocalization
