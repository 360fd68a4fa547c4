#pragma once

#include <vector>

#include "holdfast/relocalization/judging/refiner.hpp"

namespace holdfast::relocalization {

/// True for poses in the map frame that are one and the same: within 0.3 m and 3 degrees.
bool same_pose(const SE3& a, const SE3& b);

/// A mode of the wide search on its way to a candidate.
struct Prospect {
  SE3 T_map_body;  ///< of the mode
  SE3 rough;       ///< refined with few points
  double gridded_score = 0;
  double share = 0;  ///< that agrees then

  /// False for what is farther from the mode than a mode can be wrong: 1.5 m.
  bool leads_to(const SE3& refined) const;
  /// Takes what it was refined to; of no use if that was drawn away to somewhere else.
  void take(const Refined& refined);
};

/// Keeps the `most` with the greatest shares, in this order; leaves out the useless, and copies of
/// better ones.
void keep_best(std::size_t most, std::vector<Prospect>& prospects);

}  // namespace holdfast::relocalization
