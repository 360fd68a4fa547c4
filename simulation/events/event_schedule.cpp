#include "simulation/events/event_schedule.hpp"

#include <algorithm>

namespace holdfast::simulation {
namespace {

std::vector<TimeSpan> spans_of(EventKind kind, const std::vector<EventSpec>& events) {
  std::vector<TimeSpan> spans;
  for (const EventSpec& event : events) {
    if (event.kind != kind) continue;
    spans.push_back({event.start, event.start + event.duration});
  }
  return spans;
}

std::vector<BiasJump> draw_jumps(const std::vector<EventSpec>& events, const ImuModel& imu,
                                 std::uint64_t seed) {
  RandomStream random(seed, "imu.bias_jump");
  std::vector<BiasJump> jumps;
  for (const TimeNs t : starts_of(EventKind::kImuBiasJump, events)) {
    jumps.push_back(ImuSensor::draw_jump(imu, t, random));
  }
  return jumps;
}

}  // namespace

std::vector<TimeNs> starts_of(EventKind kind, const std::vector<EventSpec>& events) {
  std::vector<TimeNs> starts;
  for (const EventSpec& event : events) {
    if (event.kind == kind) starts.push_back(event.start);
  }
  std::sort(starts.begin(), starts.end());
  return starts;
}

EventSchedule::EventSchedule(const std::vector<EventSpec>& events, const ImuModel& imu,
                             const LidarClockModel& lidar_clock, std::uint64_t seed)
    : blind(spans_of(EventKind::kBlind, events)),
      lidar_off(spans_of(EventKind::kLidarOff, events)),
      imu_off(spans_of(EventKind::kImuOff, events)),
      bias_jumps(draw_jumps(events, imu, seed)),
      clock_jumps(draw_clock_jumps(events, lidar_clock, seed)) {}

std::vector<SimulatedEvent> EventSchedule::took_place(const Drive& drive, TimeNs epoch,
                                                      TimeNs length) const {
  std::vector<SimulatedEvent> out;
  const auto add = [&](EventKind kind, TimeNs t0, TimeNs t1) -> SimulatedEvent& {
    SimulatedEvent event;
    event.kind = kind;
    event.t0 = epoch + t0;
    event.t1 = epoch + std::min(t1, length);
    return out.emplace_back(event);
  };
  for (const TimeSpan& span : blind) add(EventKind::kBlind, span.begin, span.end);
  for (const TimeSpan& span : lidar_off) add(EventKind::kLidarOff, span.begin, span.end);
  for (const TimeSpan& span : imu_off) add(EventKind::kImuOff, span.begin, span.end);
  for (const BiasJump& jump : bias_jumps) {
    SimulatedEvent& event = add(EventKind::kImuBiasJump, jump.t, jump.t);
    event.gyro_step_rad_s = jump.gyro;
    event.accel_step_m_s2 = jump.accel;
  }
  for (const ClockJump& jump : clock_jumps) {
    const TimeNs end = jump.is_for_good() ? jump.span.begin : jump.span.end;
    add(EventKind::kClockJump, jump.span.begin, end).clock_step_s = to_seconds(jump.step);
  }
  for (const Teleport& teleport : drive.teleports()) {
    SimulatedEvent& event = add(EventKind::kKidnap, teleport.t, teleport.t);
    event.pose_before = teleport.before;
    event.pose_after = teleport.after;
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.t0 < b.t0; });
  return out;
}

}  // namespace holdfast::simulation
