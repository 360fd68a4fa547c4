#include "simulation/events/event_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace holdfast::simulation {
namespace {

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
    if (event.kind == kind && event.duration == 0) starts.push_back(event.start);
  }
  std::sort(starts.begin(), starts.end());
  return starts;
}

std::vector<TimeSpan> spans_of(EventKind kind, const std::vector<EventSpec>& events) {
  std::vector<TimeSpan> spans;
  for (const EventSpec& event : events) {
    if (event.kind != kind || event.duration == 0) continue;
    spans.push_back({event.start, event.start + event.duration});
  }
  std::stable_sort(spans.begin(), spans.end(),
                   [](const TimeSpan& a, const TimeSpan& b) { return a.begin < b.begin; });
  return spans;
}

namespace {

bool overlap(const TimeSpan& a, const TimeSpan& b) { return a.begin <= b.end && b.begin <= a.end; }

/// A crowd keeps with the robot, which must not go where it cannot follow.
std::string clash_of_crowds(const std::vector<EventSpec>& events) {
  for (const TimeSpan& crowd : spans_of(EventKind::kCrowd, events)) {
    for (const EventSpec& other : events) {
      if (other.kind != EventKind::kKidnap) continue;
      if (!overlap(crowd, {other.start, other.start + other.duration})) continue;
      return fmt::format(
          "event crowd at {} s: expected no kidnap while it lasts, found one at {} s",
          to_seconds(crowd.begin), to_seconds(other.start));
    }
  }
  return {};
}

}  // namespace

std::string clash(const std::vector<EventSpec>& events) {
  constexpr TimeNs kApart = 2 * kSecond;
  for (const TimeSpan& carry : spans_of(EventKind::kKidnap, events)) {
    const auto near = [&](const EventSpec& other) {
      const bool same = other.start == carry.begin && other.start + other.duration == carry.end;
      return other.kind == EventKind::kKidnap && !same && other.start < carry.end + kApart &&
             other.start + other.duration > carry.begin - kApart;
    };
    const auto other = std::find_if(events.begin(), events.end(), near);
    if (other == events.end()) continue;
    return fmt::format(
        "event kidnap at {} s: expected no other within 2 s of it, found one at {} s",
        to_seconds(carry.begin), to_seconds(other->start));
  }
  return clash_of_crowds(events);
}

EventSchedule::EventSchedule(const std::vector<EventSpec>& events, const ImuModel& imu,
                             const LidarClockModel& lidar_clock, std::uint64_t seed)
    : blind(spans_of(EventKind::kBlind, events)),
      lidar_off(spans_of(EventKind::kLidarOff, events)),
      imu_off(spans_of(EventKind::kImuOff, events)),
      carries(spans_of(EventKind::kKidnap, events)),
      crowds(spans_of(EventKind::kCrowd, events)),
      bias_jumps(draw_jumps(events, imu, seed)),
      clock_jumps(draw_clock_jumps(events, lidar_clock, seed)) {}

std::vector<TimeSpan> EventSchedule::dark() const {
  std::vector<TimeSpan> out = blind;
  out.insert(out.end(), carries.begin(), carries.end());
  return out;
}

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
  for (const TimeSpan& span : crowds) add(EventKind::kCrowd, span.begin, span.end);
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
  for (const Carry& carry : drive.carries()) {
    SimulatedEvent& event = add(EventKind::kKidnap, carry.span.begin, carry.span.end);
    event.carried = true;
    event.pose_before = carry.before;
    event.pose_after = carry.after;
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.t0 < b.t0; });
  return out;
}

}  // namespace holdfast::simulation
