#include "simulation/sensors/lidar/scan_pattern.hpp"

#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Vector3d direction(double azimuth, double elevation) {
  const double level = std::cos(elevation);
  return {level * std::cos(azimuth), level * std::sin(azimuth), std::sin(elevation)};
}

/// Share of its turn or nod that something of that rate has gone through at `t`.
double phase(double rate_hz, TimeNs t) {
  const double turns = rate_hz * to_seconds(t);
  return turns - std::floor(turns);
}

/// Each line nods over a band of its own, those of neighbouring lines against each other.
Vector3d rosette_direction(const LidarModel& model, std::size_t line, TimeNs t) {
  const RosettePattern& rosette = *model.rosette;
  const double side = line % 2 == 0 ? 1 : -1;
  const double nod = side * std::sin(kTurn * phase(rosette.nod_hz, t));
  const double elevation = model.beams[line].elevation_rad + nod * rosette.half_band_rad;
  return direction(-kTurn * phase(rosette.turn_hz, t), elevation);
}

}  // namespace

std::vector<TimeNs> column_times(const LidarModel& model) {
  std::vector<TimeNs> times;
  for (int column = 0; column < model.columns; ++column) {
    times.push_back(model.period * column / model.columns);
  }
  return times;
}

std::vector<Eigen::Vector3f> ray_directions(const LidarModel& model, std::size_t frame) {
  std::vector<Eigen::Vector3f> directions;
  for (const TimeNs column : column_times(model)) {
    for (std::size_t i = 0; i < model.beams.size(); ++i) {
      const LidarBeam& beam = model.beams[i];
      const TimeNs fired = column + beam.fire_offset;
      if (model.rosette) {
        const TimeNs t = static_cast<TimeNs>(frame) * model.period + fired;
        directions.push_back(rosette_direction(model, i, t).cast<float>());
        continue;
      }
      const double turned = static_cast<double>(fired) / static_cast<double>(model.period);
      directions.push_back(
          direction(-2 * std::numbers::pi * turned, beam.elevation_rad).cast<float>());
    }
  }
  return directions;
}

}  // namespace holdfast::simulation
