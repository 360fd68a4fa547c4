#include "simulation/events/event.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

constexpr std::array<std::string_view, 7> kNames = {
    "blind", "lidar_off", "imu_off", "imu_bias_jump", "kidnap", "clock_jump", "crowd"};
constexpr TimeNs kDefaultDuration = 2 * kSecond;
constexpr TimeNs kDefaultCrowd = 10 * kSecond;

bool lasts(EventKind kind) {
  return kind == EventKind::kBlind || kind == EventKind::kLidarOff || kind == EventKind::kImuOff;
}

bool may_last(EventKind kind) {
  return lasts(kind) || kind == EventKind::kKidnap || kind == EventKind::kClockJump ||
         kind == EventKind::kCrowd;
}

Error bad_event(const std::string& text, const std::string& found) {
  return {
      fmt::format("event '{}': expected NAME@T0[+DURATION] with seconds from the start of the "
                  "log and NAME one of {}; found {}",
                  text, fmt::join(kNames, ", "), found)};
}

std::string pose_json(const SE3& pose) {
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format("[{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}]", p.x(), p.y(), p.z(),
                     q.x(), q.y(), q.z(), q.w());
}

std::string vector_json(const Eigen::Vector3d& v) {
  return fmt::format("[{:.9f},{:.9f},{:.9f}]", v.x(), v.y(), v.z());
}

std::string details_json(const SimulatedEvent& event) {
  switch (event.kind) {
    case EventKind::kBlind:
    case EventKind::kLidarOff:
    case EventKind::kImuOff:
    case EventKind::kCrowd: return "";
    case EventKind::kImuBiasJump:
      return fmt::format(",\"gyro_step_rad_s\":{},\"accel_step_m_s2\":{}",
                         vector_json(event.gyro_step_rad_s), vector_json(event.accel_step_m_s2));
    case EventKind::kClockJump: return fmt::format(",\"step_s\":{:.9f}", event.clock_step_s);
    case EventKind::kKidnap: break;
  }
  const double distance = (event.pose_after.translation - event.pose_before.translation).norm();
  const double angle = so3::angle_between(event.pose_before.rotation, event.pose_after.rotation);
  return fmt::format(
      "{},\"pose_before\":{},\"pose_after\":{},\"distance_m\":{:.6f},\"angle_deg\":{:.6f}",
      event.carried ? ",\"carried\":true" : "", pose_json(event.pose_before),
      pose_json(event.pose_after), distance, angle * 180 / std::numbers::pi);
}

}  // namespace

std::string_view event_name(EventKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::vector<std::string_view> event_names() { return {kNames.begin(), kNames.end()}; }

Result<EventSpec> parse_event(const std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos) return bad_event(text, "no '@'");
  const std::string name = text.substr(0, at);
  EventSpec event;
  std::size_t kind = 0;
  while (kind < kNames.size() && kNames[kind] != name) ++kind;
  if (kind == kNames.size()) return bad_event(text, fmt::format("the name '{}'", name));
  event.kind = static_cast<EventKind>(kind);
  const std::size_t plus = text.find('+', at);
  const std::string start = text.substr(at + 1, plus == std::string::npos ? plus : plus - at - 1);
  if (!parse_seconds(start, event.start) || event.start < 0) {
    return bad_event(text, fmt::format("the start '{}'", start));
  }
  if (lasts(event.kind)) event.duration = kDefaultDuration;
  if (event.kind == EventKind::kCrowd) event.duration = kDefaultCrowd;
  if (plus == std::string::npos) return event;
  const std::string duration = text.substr(plus + 1);
  if (!may_last(event.kind)) {
    return bad_event(text, fmt::format("a duration, which {} does not take", name));
  }
  if (!parse_seconds(duration, event.duration) || event.duration <= 0) {
    return bad_event(text, fmt::format("the duration '{}'", duration));
  }
  return event;
}

std::string event_json(const SimulatedEvent& event) {
  return fmt::format("{{\"t0\":{},\"t1\":{},\"event\":\"{}\"{}}}", format_seconds(event.t0),
                     format_seconds(event.t1), event_name(event.kind), details_json(event));
}

}  // namespace holdfast::simulation
