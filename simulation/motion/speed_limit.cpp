#include "simulation/motion/speed_limit.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {
namespace {

constexpr double kStep = 0.05;  // metres, about

double limit_in_turn(const Route::Place& place, const DriveStyle& style) {
  if (place.on_spot) return Route::kSpotMetresPerRadian * style.yaw_rate_rad_s;
  const double k = std::abs(place.curvature);
  if (k < 1e-9) return style.speed_m_s;
  return std::min({style.speed_m_s, style.yaw_rate_rad_s / k, std::sqrt(style.lateral_m_s2 / k)});
}

}  // namespace

SpeedLimit::SpeedLimit(const Route& route, const DriveStyle& style) : length_(route.length()) {
  const auto n = static_cast<std::size_t>(std::ceil(length_ / kStep));
  step_ = length_ / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    speed_.push_back(limit_in_turn(route.at(static_cast<double>(i) * step_), style));
  }
  for (std::size_t i = 2 * n; i-- > 0;) {  // two rounds backwards: v^2 <= v_next^2 + 2 a step
    const double next = speed_[(i + 1) % n];
    const double reachable = std::sqrt(next * next + 2 * style.acceleration_m_s2 * step_);
    speed_[i % n] = std::min(speed_[i % n], reachable);
  }
}

double SpeedLimit::at(double s) const {
  const double in_round = s - std::floor(s / length_) * length_;
  const auto i = static_cast<std::size_t>(in_round / step_);
  return speed_[std::min(i, speed_.size() - 1)];
}

}  // namespace holdfast::simulation
