#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "holdfast/monitor/evidence/looks.hpp"

namespace holdfast::monitor {

/// What may be the case. At a right pose the world may be as mapped, changed, full of people, or
/// not in the map at all; a wrong pose may look strange, look much like the right one, or be
/// outside of the map, where nothing tells right from wrong.
enum class Hypothesis : std::uint8_t {
  kUsual,
  kChanged,
  kCrowded,
  kOutside,
  kWrongStrange,
  kWrongAlike,
  kWrongOutside
};
inline constexpr std::size_t kHypotheses = 7;

constexpr bool is_wrong(std::size_t hypothesis) {
  return hypothesis >= static_cast<std::size_t>(Hypothesis::kWrongStrange);
}

/// Logarithm of a likelihood, one for each hypothesis.
using LogLikelihoods = std::array<double, kHypotheses>;

/// The witnesses whose words count, in the order of Testimony.
enum class Witness : std::uint8_t { kFitting, kPaired, kThrough, kUnmapped, kWay };
inline constexpr std::array<std::string_view, 5> kWitnessNames = {"fitting", "paired", "through",
                                                                  "unmapped", "way"};

/// What each witness says of each hypothesis.
using Testimony = std::array<LogLikelihoods, kWitnessNames.size()>;

/// Likelihoods of a scan's shares. Each share is taken for kIndependentLooks looks, however many
/// thousand points it was made from: neighbours hit the same wall, and err together. Their number
/// is beta-binomial about what the hypothesis expects at this place; how narrow is a matter of how
/// alike places of that kind are (docs/decisions/0009).
void testify(const Looks& seen, const UsualLooks& usual, Testimony& testimony);

/// Likelihood of the squared Mahalanobis distance (6 degrees of freedom) between the way that the
/// map's poses tell and the odometry's. At a right pose it is chi-square, but for the odometry's
/// own failures; at a wrong one it may be of any size. That a wrong place goes along is as likely:
/// this witness speaks against a pose only.
void testify_way(double squared_distance, Testimony& testimony);

}  // namespace holdfast::monitor
