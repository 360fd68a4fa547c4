#pragma once

#include <Eigen/Core>

namespace holdfast::simulation {

/// A place on the WGS 84 ellipsoid.
struct GeodeticPosition {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;  ///< above the ellipsoid
};

/// Where on earth the map's origin lies; x points east, y north, z up (ENU).
struct MapDatum {
  GeodeticPosition origin{50, 10, 200};

  GeodeticPosition to_geodetic(const Eigen::Vector3d& p_map) const;
  Eigen::Vector3d to_map(const GeodeticPosition& position) const;
};

}  // namespace holdfast::simulation
