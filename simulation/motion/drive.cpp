#include "simulation/motion/drive.hpp"

#include <algorithm>

#include "simulation/motion/drive_planner.hpp"

namespace holdfast::simulation {

DriveStyle DriveStyle::faster(double factor) const {
  DriveStyle style = *this;
  style.speed_m_s *= factor;
  style.yaw_rate_rad_s *= factor;
  style.acceleration_m_s2 *= factor;
  style.lateral_m_s2 *= factor;
  return style;
}

DriveStyle DriveStyle::in_hand() const {
  DriveStyle style = *this;
  style.speed_m_s = 2;
  style.pace_share = 0.5;
  style.acceleration_m_s2 = 1.5;
  style.yaw_rate_rad_s = 1;
  style.lateral_m_s2 = 1.5;
  style.body_height_m = 1.2;
  style.wobble_rad = 0.03;
  style.step_heave_m = 0.02;
  style.step_sway_m = 0.02;
  style.gesture_rad = 0.8;
  style.gesture_rad_s = 3;
  return style;
}

Drive Drive::plan(const Route& route, const DriveStyle& style, std::uint64_t seed,
                  std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps,
                  const std::vector<TimeSpan>& carries, const std::vector<TimeSpan>& crowds) {
  DrivePlanner planner(route, style, seed);
  planner.slow_down_in(crowds);
  planner.drive(duration, kidnaps, carries);
  Drive drive;
  drive.duration_ = planner.duration();
  drive.pieces_ = planner.trajectories();
  drive.rides_ = planner.rides();
  for (std::size_t leg = 1; leg < planner.legs(); ++leg) {
    const TimeNs t = planner.leg_start(leg);
    drive.starts_.push_back(t);
    if (planner.is_carried(leg)) continue;
    drive.teleports_.push_back(
        {t, drive.pieces_[leg - 1].at(t).T_map_body, drive.pieces_[leg].at(t).T_map_body});
  }
  const std::vector<TimeNs>& needed = planner.needed_for_carries();
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const TimeSpan& span = carries[i];
    drive.carries_.push_back(
        {span, drive.at(span.begin).T_map_body, drive.at(span.end).T_map_body, needed[i]});
  }
  return drive;
}

MotionState Drive::at(TimeNs t) const {
  t = std::clamp<TimeNs>(t, 0, duration_);
  std::size_t piece = 0;
  while (piece < starts_.size() && starts_[piece] <= t) ++piece;
  return pieces_[piece].at(t);
}

}  // namespace holdfast::simulation
