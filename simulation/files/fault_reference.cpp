#include "simulation/files/fault_reference.hpp"

#include <fmt/format.h>

#include <numbers>

#include "simulation/sensors/gnss/gnss_receiver.hpp"
#include "simulation/sensors/wheel/wheel_odometer.hpp"
#include "simulation/stated_extrinsics.hpp"
#include "simulation/transport/transport_model.hpp"

namespace holdfast::simulation {
namespace {

std::string clock_text() {
  const LidarClockModel clock = TransportModel::unsynchronised_clock();
  return fmt::format(
      "# Clocks\n\n"
      "The IMU's clock shows the true time. `truth.tum`, `events.jsonl`, the stamps of\n"
      "`/imu`, `/wheel_odometry` and `/gnss` and the times at which messages were recorded\n"
      "follow it. The stamps of `/points` and the times of its points follow the LiDAR's\n"
      "clock, which is the same unless one of these is asked for:\n\n"
      "- `--faults clock`: ahead at the start by a normal value of {} ms, gaining one of {}\n"
      "  ppm, each drawn once a seed; each scan's stamp jitters by {} ms. `config.yaml`\n"
      "  says as a comment what was drawn.\n"
      "- `--event clock_jump@T0`: at T0 the clock steps by {} to {} ms, forwards or back,\n"
      "  drawn per seed, for good; `clock_jump@T0+DURATION` steps back after the duration.\n"
      "  `events.jsonl` says the size as `step_s`. The clock is read once a scan, so that a\n"
      "  step never falls into one.\n\n"
      "An estimate carries the LiDAR's stamps. To compare it with `truth.tum` as if the\n"
      "clock were right, take what the clock is ahead off its stamps; without that, a robot\n"
      "at v m/s whose clock is d s ahead is charged with v d m.\n\n",
      1e3 * clock.offset_sigma_s, clock.drift_sigma_ppm, 1e3 * clock.jitter_sigma_s,
      1e3 * clock.jump_least_s, 1e3 * clock.jump_most_s);
}

std::string loss_text() {
  const TransportModel losses = TransportModel().with_losses();
  const ExtrinsicsError error = ExtrinsicsError::by_hand();
  return fmt::format(
      "# Losses and extrinsics\n\n"
      "- `--faults packets`: {} % of the LiDAR's packets of {} columns are missing, in runs\n"
      "  of {} on average, and {} % of the IMU's samples, in runs of {}.\n"
      "- `--faults extrinsics`: `T_body_lidar` in `config.yaml` is off by {} cm and {}\n"
      "  degrees in directions drawn per seed; a comment says the true one.\n\n",
      100 * losses.lidar_packets.lost_share, losses.columns_per_packet,
      losses.lidar_packets.mean_run, 100 * losses.imu_samples.lost_share,
      losses.imu_samples.mean_run, 100 * error.position_m,
      error.angle_rad * 180 / std::numbers::pi);
}

std::string wheel_text() {
  const WheelModel wheel;
  return fmt::format(
      "# Wheels\n\n"
      "`--wheel` adds `/wheel_odometry` (`nav_msgs/Odometry`, {} Hz): speed along x and yaw\n"
      "rate of `body` from ticks of {} mm of two wheels {} m apart, and the pose in\n"
      "`wheel_odom` that they sum up to. Each wheel's radius is wrong by {} % (sigma, drawn\n"
      "once a seed); in turns wheels turn {} % further apart than the ground; {} times a\n"
      "minute one of them spins {} % too fast for {} s on average. The covariances know of\n"
      "ticks and radii, not of slip.\n\n",
      wheel.rate_hz, 1e3 / wheel.ticks_per_m, wheel.track_m, 100 * wheel.scale_sigma,
      100 * wheel.turn_slip, wheel.slips_per_minute, 100 * wheel.slip_share, wheel.slip_mean_s);
}

std::string gnss_text() {
  const GnssModel gnss;
  const GeodeticPosition& origin = gnss.datum.origin;
  return fmt::format(
      "# GNSS\n\n"
      "`--gnss` adds `/gnss` (`sensor_msgs/NavSatFix`, {} Hz): where an antenna {} m above\n"
      "the body's origin is, east and north within {} cm (sigma) at rest and {} cm moving,\n"
      "up {} times as bad, white. Outages ({} a minute, status -1, NaN) last {} s on\n"
      "average; roofs do not matter. The map's origin lies at latitude {}, longitude {},\n"
      "altitude {} m (WGS 84), its x points east, its y north.\n",
      gnss.rate_hz, gnss.p_body_antenna.z(), 100 * gnss.rest_sigma_m, 100 * gnss.moving_sigma_m,
      gnss.up_factor, gnss.outages_per_minute, gnss.outage_mean_s, origin.latitude_deg,
      origin.longitude_deg, origin.altitude_m);
}

}  // namespace

std::string fault_reference() { return clock_text() + loss_text() + wheel_text() + gnss_text(); }

}  // namespace holdfast::simulation
