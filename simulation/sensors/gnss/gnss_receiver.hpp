#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "simulation/events/time_span.hpp"
#include "simulation/motion/drive.hpp"
#include "simulation/sensors/gnss/map_datum.hpp"

namespace holdfast::simulation {

/// A receiver with corrections of a base station. Roofs and walls do not shade it: outages come at
/// random. Errors are white.
struct GnssModel {
  double rate_hz = 10;
  double rest_sigma_m = 0.02;    ///< of east and north while the antenna stands
  double moving_sigma_m = 0.05;  ///< likewise while it moves
  double up_factor = 2;          ///< how much worse the altitude is
  double moving_m_s = 0.05;      ///< from this speed on it moves
  double outages_per_minute = 1;
  double outage_mean_s = 5;
  Eigen::Vector3d p_body_antenna{0, 0, 0.3};
  MapDatum datum;
};

/// Measures where the antenna is.
class GnssReceiver {
 public:
  /// Over a log of this length. Streams: "gnss.noise", "gnss.outage".
  GnssReceiver(const GnssModel& model, std::uint64_t seed, TimeNs length);

  const std::vector<TimeSpan>& outages() const { return outages_; }

  /// One sample an interval from the start on, without a fix in outages; times from the start.
  std::vector<GnssSample> samples(const Drive& drive) const;

 private:
  GnssModel model_;
  std::uint64_t seed_;
  TimeNs length_;
  std::vector<TimeSpan> outages_;
};

}  // namespace holdfast::simulation
