#include "simulation/sensors/lidar/returns/link_budget.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {

LinkBudget::LinkBudget(double reach_at_10_percent_m, double extinction_per_m)
    : scale_(reach_at_10_percent_m * reach_at_10_percent_m / 0.1), extinction_(extinction_per_m) {}

double LinkBudget::strength(double reflected_share, double range_m) const {
  const double through_air = extinction_ == 0 ? 1 : std::exp(-2 * extinction_ * range_m);
  return reflected_share * through_air * scale_ / (range_m * range_m);
}

double LinkBudget::seen_probability(double strength) {
  constexpr double kSure = 2.7;  // Phi(8.5) is 1 in double precision
  if (strength >= kSure) return 1;
  return 0.5 * std::erfc(-kThresholdToNoise * (strength - 1) / std::sqrt(2.0));
}

double range_sigma(const LidarModel& lidar, double range_m, double cos_incidence) {
  const LidarFaults& faults = lidar.faults;
  const double far = faults.range_noise_per_m * range_m;
  const double cosine = std::clamp(cos_incidence, 1e-6, 1.0);
  const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
  const double tilted = faults.incidence_noise * range_m * lidar.divergence_rad / 4 * tangent;
  const double sigma =
      std::sqrt(lidar.range_sigma_m * lidar.range_sigma_m + far * far + tilted * tilted);
  return std::min(sigma, std::max(faults.most_range_sigma_m, lidar.range_sigma_m));
}

}  // namespace holdfast::simulation
