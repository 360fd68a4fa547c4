#include "simulation/sensors/gnss/gnss_receiver.hpp"

#include <limits>

#include "holdfast/core/random.hpp"
#include "simulation/events/random_spans.hpp"
#include "simulation/sensors/imu/normal_vector.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;

GnssReceiver::GnssReceiver(const GnssModel& model, std::uint64_t seed, TimeNs length)
    : model_(model),
      seed_(seed),
      length_(length),
      outages_(draw_spans(model.outages_per_minute, model.outage_mean_s, length,
                          RandomStream(seed, "gnss.outage"))) {}

std::vector<GnssSample> GnssReceiver::samples(const Drive& drive) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const TimeNs interval = from_seconds(1 / model_.rate_hz);
  RandomStream noise(seed_, "gnss.noise");
  std::vector<GnssSample> out;
  for (TimeNs t = 0; t <= length_; t += interval) {
    const MotionState motion = drive.at(t);
    const Eigen::Quaterniond& R_map_body = motion.T_map_body.rotation;
    const Vector3d v_antenna =
        motion.v_map + R_map_body * motion.omega_body.cross(model_.p_body_antenna);
    const bool moves = v_antenna.norm() >= model_.moving_m_s;
    const double sigma = moves ? model_.moving_sigma_m : model_.rest_sigma_m;
    GnssSample sample{t, !any_contains(outages_, t), kNone, kNone, kNone, Vector3d::Zero()};
    // Drawn in outages too, so that these do not change the noise of what follows.
    const Vector3d error =
        sigma * Vector3d(1, 1, model_.up_factor).cwiseProduct(normal_vector(noise));
    if (sample.has_fix) {
      const auto place =
          model_.datum.to_geodetic(motion.T_map_body * model_.p_body_antenna + error);
      sample.latitude_deg = place.latitude_deg;
      sample.longitude_deg = place.longitude_deg;
      sample.altitude_m = place.altitude_m;
      sample.sigma_enu_m = sigma * Vector3d(1, 1, model_.up_factor);
    }
    out.push_back(sample);
  }
  return out;
}

}  // namespace holdfast::simulation
