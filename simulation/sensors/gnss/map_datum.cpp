#include "simulation/sensors/gnss/map_datum.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSemiMajorM = 6378137;
constexpr double kFlattening = 1 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2 - kFlattening);

/// Radius of curvature in the prime vertical.
double normal_radius(double latitude_rad) {
  const double s = std::sin(latitude_rad);
  return kSemiMajorM / std::sqrt(1 - kEccentricity2 * s * s);
}

Vector3d to_ecef(const GeodeticPosition& position) {
  const double lat = position.latitude_deg * kDegree;
  const double lon = position.longitude_deg * kDegree;
  const double n = normal_radius(lat);
  const double across = (n + position.altitude_m) * std::cos(lat);
  return {across * std::cos(lon), across * std::sin(lon),
          (n * (1 - kEccentricity2) + position.altitude_m) * std::sin(lat)};
}

/// Columns: east, north and up in the earth's axes.
Matrix3d enu_axes(const GeodeticPosition& origin) {
  const double lat = origin.latitude_deg * kDegree;
  const double lon = origin.longitude_deg * kDegree;
  Matrix3d axes;
  axes.col(0) = Vector3d(-std::sin(lon), std::cos(lon), 0);
  axes.col(2) =
      Vector3d(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

}  // namespace

// The latitude by fixed-point iteration, each round of which leaves 1/300 of the error.
GeodeticPosition MapDatum::to_geodetic(const Vector3d& p_map) const {
  constexpr int kRounds = 8;
  const Vector3d p = to_ecef(origin) + enu_axes(origin) * p_map;
  const double across = std::hypot(p.x(), p.y());
  double lat = std::atan2(p.z(), across * (1 - kEccentricity2));
  for (int round = 0; round < kRounds; ++round) {
    lat = std::atan2(p.z() + kEccentricity2 * normal_radius(lat) * std::sin(lat), across);
  }
  const double n = normal_radius(lat);
  const double altitude = across * std::cos(lat) + p.z() * std::sin(lat) -
                          n * (1 - kEccentricity2 * std::sin(lat) * std::sin(lat));
  return {lat / kDegree, std::atan2(p.y(), p.x()) / kDegree, altitude};
}

Vector3d MapDatum::to_map(const GeodeticPosition& position) const {
  return enu_axes(origin).transpose() * (to_ecef(position) - to_ecef(origin));
}

}  // namespace holdfast::simulation
