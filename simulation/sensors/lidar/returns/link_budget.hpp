#pragma once

#include "simulation/sensors/lidar/lidar_model.hpp"

namespace holdfast::simulation {

/// How often an echo is strong enough to be seen. Its strength against the weakest that is seen, of
/// a surface of 10 % at the stated reach R10, square to the beam and in clear air:
///   s = power reflectivity cos(theta) exp(-2 extinction r) / r^2 * R10^2 / 0.1.
/// The receiver's threshold stands kThresholdToNoise above its noise, which is normal:
///   P(seen) = Phi(kThresholdToNoise (s - 1)).
class LinkBudget {
 public:
  static constexpr double kThresholdToNoise = 5;  ///< usual for one false alarm in 10^6 samples

  LinkBudget(double reach_at_10_percent_m, double extinction_per_m);

  double strength(double reflected_share, double range_m) const;
  /// Of an echo of that strength.
  static double seen_probability(double strength);

 private:
  double scale_;
  double extinction_;
};

/// Standard deviation of a range in metres, see LidarFaults.
double range_sigma(const LidarModel& lidar, double range_m, double cos_incidence);

}  // namespace holdfast::simulation
