#include "simulation/transport/lidar_clock.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

/// Lets the times within a scan run `pace` times as fast.
void stretch(Scan& scan, double pace) {
  const auto stretched = [pace](TimeNs t) { return std::llround(pace * static_cast<double>(t)); };
  for (ScanPoint& point : scan.points) {
    point.time_offset_ns = static_cast<std::int32_t>(stretched(point.time_offset_ns));
  }
  scan.end_time = scan.stamp + stretched(scan.end_time - scan.stamp);
}

void shift(Scan& scan, TimeNs step) {
  scan.stamp += step;
  scan.end_time += step;
}

}  // namespace

std::vector<ClockJump> draw_clock_jumps(const std::vector<EventSpec>& events,
                                        const LidarClockModel& model, std::uint64_t seed) {
  std::vector<ClockJump> jumps;
  for (const EventSpec& event : events) {
    if (event.kind != EventKind::kClockJump) continue;
    const TimeNs end = event.duration > 0 ? event.start + event.duration : ClockJump::kNever;
    jumps.push_back({{event.start, end}, 0});
  }
  std::sort(jumps.begin(), jumps.end(),
            [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
  RandomStream random(seed, "lidar.clock_jump");
  for (ClockJump& jump : jumps) {
    const double size_s = random.uniform(model.jump_least_s, model.jump_most_s);
    jump.step = from_seconds(random.uniform() < 0.5 ? -size_s : size_s);
  }
  return jumps;
}

LidarClock::LidarClock(const LidarClockModel& model, const std::vector<ClockJump>& jumps,
                       std::uint64_t seed)
    : is_true_(model.is_true() && jumps.empty()),
      jitter_sigma_s_(model.jitter_sigma_s),
      seed_(seed),
      jumps_(jumps),
      offset_s_(model.offset_sigma_s * RandomStream(seed, "lidar.clock_offset").normal()),
      drift_ppm_(model.drift_sigma_ppm * RandomStream(seed, "lidar.clock_drift").normal()) {}

TimeNs LidarClock::read(TimeNs t) const {
  TimeNs shown = t + from_seconds(offset_s_ + 1e-6 * drift_ppm_ * to_seconds(t));
  for (const ClockJump& jump : jumps_) shown += jump.span.contains(t) ? jump.step : 0;
  return shown;
}

void LidarClock::stamp(Scan& scan, std::size_t index) {
  if (is_true_) return;
  RandomStream random(seed_, "lidar.stamp_jitter." + std::to_string(index));
  const TimeNs true_stamp = scan.stamp;
  const TimeNs jitter = from_seconds(jitter_sigma_s_ * random.normal());
  stretch(scan, 1 + 1e-6 * drift_ppm_);
  shift(scan, read(true_stamp) + jitter - true_stamp);
  true_stamps_[scan.stamp] = true_stamp;
}

Scan LidarClock::in_true_time(const Scan& scan) const {
  Scan out = scan;
  const auto known = true_stamps_.find(scan.stamp);
  if (known == true_stamps_.end()) return out;
  stretch(out, 1 / (1 + 1e-6 * drift_ppm_));
  shift(out, known->second - out.stamp);
  return out;
}

}  // namespace holdfast::simulation
