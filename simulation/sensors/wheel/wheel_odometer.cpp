#include "simulation/sensors/wheel/wheel_odometer.hpp"

#include <cmath>

#include "holdfast/core/random.hpp"
#include "simulation/events/random_spans.hpp"

namespace holdfast::simulation {
namespace {

constexpr int kSteps = 4;  // of the integration over an interval, whose motion is smooth

/// The next pose on an arc in the plane.
SE3 go_on(const SE3& T_odom_body, double way_m, double turn_rad) {
  const double half = turn_rad / 2;
  const double chord = std::abs(half) < 1e-9 ? way_m : way_m * std::sin(half) / half;
  const SE3 step{so3::exp(Eigen::Vector3d(0, 0, turn_rad)),
                 Eigen::Vector3d(chord * std::cos(half), chord * std::sin(half), 0)};
  return T_odom_body * step;
}

}  // namespace

WheelOdometer::WheelOdometer(const WheelModel& model, std::uint64_t seed, TimeNs length)
    : model_(model), length_(length) {
  RandomStream scale(seed, "wheel.scale");
  for (double& wheel : scales_) wheel = scale.normal(1, model.scale_sigma);
  RandomStream side(seed, "wheel.slip_side");
  for (const TimeSpan& span : draw_spans(model.slips_per_minute, model.slip_mean_s, length,
                                         RandomStream(seed, "wheel.slip"))) {
    slips_.push_back({span, static_cast<int>(side.below(2))});
  }
}

std::array<double, 2> WheelOdometer::wheel_speeds(const MotionState& motion, TimeNs t) const {
  const double forward = (motion.T_map_body.rotation.conjugate() * motion.v_map).x();
  const double apart = motion.omega_body.z() * model_.track_m / 2 * (1 + model_.turn_slip);
  std::array<double, 2> speeds = {scales_[0] * (forward - apart), scales_[1] * (forward + apart)};
  for (const Slip& slip : slips_) {
    if (!slip.span.contains(t)) continue;
    speeds[static_cast<std::size_t>(slip.wheel)] *= 1 + model_.slip_share;
  }
  return speeds;
}

std::vector<WheelSample> WheelOdometer::samples(const Drive& drive) const {
  const TimeNs interval = from_seconds(1 / model_.rate_hz);
  const double dt = to_seconds(interval);
  const double tick_m = 1 / model_.ticks_per_m;
  const double rounding = tick_m / dt / std::sqrt(6.0);  // of a wheel's speed: two ends are cut
  std::vector<WheelSample> out;
  std::array<double, 2> way_m{};
  std::array<double, 2> counted_m{};
  WheelSample sample;
  for (TimeNs end = interval; end <= length_; end += interval) {
    std::array<double, 2> speeds{};
    for (int step = 0; step < kSteps; ++step) {
      const TimeNs t = end - interval + interval * (2 * step + 1) / (2 * kSteps);
      const auto now = wheel_speeds(drive.at(t), t);
      for (std::size_t wheel = 0; wheel < 2; ++wheel) way_m[wheel] += now[wheel] * dt / kSteps;
    }
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const double shown = tick_m * std::floor(way_m[wheel] / tick_m);
      speeds[wheel] = (shown - counted_m[wheel]) / dt;
      counted_m[wheel] = shown;
    }
    sample.t = end;
    sample.speed_m_s = (speeds[0] + speeds[1]) / 2;
    sample.yaw_rate_rad_s = (speeds[1] - speeds[0]) / model_.track_m;
    const double wheel_sigma = std::hypot(rounding, model_.scale_sigma * sample.speed_m_s);
    sample.speed_sigma_m_s = wheel_sigma / std::sqrt(2.0);
    sample.yaw_rate_sigma_rad_s = wheel_sigma * std::sqrt(2.0) / model_.track_m;
    sample.T_odom_body =
        go_on(sample.T_odom_body, sample.speed_m_s * dt, sample.yaw_rate_rad_s * dt);
    out.push_back(sample);
  }
  return out;
}

}  // namespace holdfast::simulation
