#pragma once

#include "holdfast/monitor/sight_lines.hpp"

namespace holdfast::monitor {

/// What a scan shows of whether the pose is right: shares, each in [0, 1].
struct Looks {
  double fitting = 0;   ///< of the points paired with a surface of the map: mean robust weight
  double paired = 0;    ///< of the points, with a surface within the gate
  double through = 0;   ///< of the rays, that pass through a wall of the map
  double unmapped = 0;  ///< of the other rays, that end where the map has nothing at all

  /// Of the points; the others belong to other surfaces than the map has, or to other places.
  double agreeing() const { return fitting * paired; }
};

/// `weight`: sum of the robust weights of `pairs` pairs of `points` points.
Looks looks_of(double weight, double pairs, double points, const SightCounts& sight);

/// What `fitting` is at a right pose, wherever that is: the residuals are whitened. (0.82 to 0.92
/// in all worlds and in the article's hall; at wrong poses 0.25 to 0.7 indoors,
/// docs/decisions/0009.)
inline constexpr double kUsualFitting = 0.87;

/// The other three as they are at a right pose in an unchanged world: they differ from place to
/// place (glass, leaves, clutter, the border of the map), and only against them tells a scan.
struct UsualLooks {
  double paired = 0;
  double through = 0;
  double unmapped = 0;
  /// How many independent looks that is worth: what is known of the place.
  double worth = 15;
};

}  // namespace holdfast::monitor
