#pragma once

#include "holdfast/monitor/sight_lines.hpp"

namespace holdfast::monitor {

/// What a scan shows of whether the pose is right: three shares, each in [0, 1].
struct Looks {
  double agreeing = 0;  ///< of the points, with surfaces of the map (sum of robust weights)
  double through = 0;   ///< of the rays, that pass through a wall of the map
  double unmapped = 0;  ///< of the other rays, that end where the map has nothing at all

  static Looks of(double agreeing_share, const SightCounts& sight);
};

/// The same three as they are at a right pose in an unchanged world: they differ from place to
/// place (glass, leaves, clutter, the border of the map), and only against them tells a scan.
struct UsualLooks {
  Looks mean{};
  /// How many independent looks the mean is worth: what is known of the place.
  double worth = 30;
};

}  // namespace holdfast::monitor
