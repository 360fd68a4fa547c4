#include "simulation/sensors/lidar/returns/air.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace holdfast::simulation {
namespace {

// Assumed, from what tests in rain chambers and fog show: echoes of the air lie within the first
// ten metres or so; one beam in a hundred meets one at 20 mm/h, one in five where one sees 50 m.
constexpr double kFallOff = 4;            // metres
constexpr double kRainDensity = 1.25e-4;  // echoes a metre, for each mm/h
constexpr double kDustDensity = 1;        // echoes for each metre over which dust takes 1 - 1/e

constexpr double kMostRain = 200;       // mm/h
constexpr double kLeastVisibility = 5;  // metres
constexpr double kMostVisibility = 1e5;

double rain_extinction(double rain_mm_h) {
  const double db_per_km = 1.076 * std::pow(rain_mm_h, 0.67);
  return 1e-3 * db_per_km * std::log(10) / 10;
}

double dust_extinction(double visibility_m) {
  return visibility_m > 0 ? std::log(20) / visibility_m : 0;
}

}  // namespace

std::string complaint(const Weather& weather) {
  if (!(weather.rain_mm_h >= 0 && weather.rain_mm_h <= kMostRain)) {
    return fmt::format("rain of {} mm/h: expected 0 to {}", weather.rain_mm_h, kMostRain);
  }
  const double visibility = weather.visibility_m;
  if (visibility != 0 && !(visibility >= kLeastVisibility && visibility <= kMostVisibility)) {
    return fmt::format("visibility of {} m: expected {} to {}, or 0 for clear air", visibility,
                       kLeastVisibility, kMostVisibility);
  }
  return {};
}

Air::Air(const Weather& weather)
    : extinction_((weather.rain_mm_h > 0 ? rain_extinction(weather.rain_mm_h) : 0) +
                  dust_extinction(weather.visibility_m)),
      density_(kRainDensity * weather.rain_mm_h +
               kDustDensity * dust_extinction(weather.visibility_m)) {}

double Air::echoes(double from_m, double to_m) const {
  return density_ * kFallOff * (std::exp(-from_m / kFallOff) - std::exp(-to_m / kFallOff));
}

// echoes(from, r) = depth, solved for r.
double Air::first_echo(double from_m, double to_m, double depth) const {
  if (depth >= echoes(from_m, to_m)) return std::numeric_limits<double>::infinity();
  return -kFallOff * std::log(std::exp(-from_m / kFallOff) - depth / (density_ * kFallOff));
}

}  // namespace holdfast::simulation
