#include "simulation/simulation_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

/// What is wrong with the options that make a drive harder, empty when nothing is.
std::string hardship_complaint(const SimulationOptions& options) {
  if (!(options.changed_share >= 0 && options.changed_share <= 1)) {
    return fmt::format("{} % of the world changed: expected 0 to 100", 100 * options.changed_share);
  }
  if (!(options.map_sigma_m >= 0 && options.map_sigma_m <= 1)) {
    return fmt::format("map noise of {} m: expected 0 to 1", options.map_sigma_m);
  }
  if (!(options.lidar.range_sigma_m >= 0 && options.lidar.range_sigma_m <= 1)) {
    return fmt::format("range noise of {} m: expected 0 to 1", options.lidar.range_sigma_m);
  }
  if (!(options.speed_factor >= 0.1 && options.speed_factor <= 10)) {
    return fmt::format("{} times the speed: expected 0.1 to 10", options.speed_factor);
  }
  if (const std::string wrong = complaint(options.weather); !wrong.empty()) return wrong;
  constexpr double kMostWobble = 30 * std::numbers::pi / 180;  // pitch stays far from 90 degrees
  if (!(options.wobble_rad >= 0 && options.wobble_rad <= kMostWobble)) {
    return fmt::format("wobble of {} degrees: expected 0 to 30",
                       options.wobble_rad * 180 / std::numbers::pi);
  }
  return {};
}

/// Likewise of those that lose and misdate measurements.
std::string transport_complaint(const TransportModel& transport) {
  for (const LossModel* loss : {&transport.lidar_packets, &transport.imu_samples}) {
    if (!(loss->lost_share >= 0 && loss->lost_share <= 0.5 && loss->mean_run >= 1)) {
      return fmt::format("losses of a share of {} in runs of {}: expected 0 to 0.5, at least 1",
                         loss->lost_share, loss->mean_run);
    }
  }
  if (transport.columns_per_packet < 1) {
    return fmt::format("{} columns in a packet: expected at least 1", transport.columns_per_packet);
  }
  return {};
}

}  // namespace

DriveStyle style_of(const Scenario& scenario, const SimulationOptions& options) {
  DriveStyle style = scenario.style;
  if (options.motion == Motion::kHandheld) style = style.in_hand();
  if (options.motion == Motion::kTurnOnSpot) style.turn_on_spot = true;
  style = style.faster(options.speed_factor);
  if (options.wobble_rad > 0) style.wobble_rad = options.wobble_rad;
  return style;
}

std::string complaint(const Scenario& scenario, const SimulationOptions& options) {
  if (const std::string hard = hardship_complaint(options); !hard.empty()) return hard;
  if (const std::string lossy = transport_complaint(options.transport); !lossy.empty()) {
    return lossy;
  }
  const double interval = 1e9 / options.imu.rate_hz;
  if (!(options.imu.rate_hz > 0) || std::abs(interval - std::round(interval)) > 1e-6) {
    return fmt::format("imu rate of {} Hz: expected a whole number of nanoseconds between samples",
                       options.imu.rate_hz);
  }
  const LidarModel& lidar = options.lidar;
  if (lidar.beams.empty() || lidar.columns < 1 || lidar.period < 1) {
    return fmt::format("lidar with {} beams, {} columns and a period of {} ns: expected some",
                       lidar.beams.size(), lidar.columns, lidar.period);
  }
  if (scenario.world.is_empty()) {
    return fmt::format("scenario '{}': its world has no surface", scenario.name);
  }
  if (options.duration_s && !(*options.duration_s >= 0.5 && *options.duration_s <= 1e6)) {
    return fmt::format("duration of {} s: expected 0.5 to 1000000", *options.duration_s);
  }
  if (options.threads < 1) return fmt::format("{} threads: expected at least 1", options.threads);
  return {};
}

}  // namespace holdfast::simulation
