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

Drive Drive::plan(const Route& route, const DriveStyle& style, std::uint64_t seed,
                  std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps) {
  DrivePlanner planner(route, style, seed);
  planner.drive(duration, kidnaps);
  Drive drive;
  drive.duration_ = planner.duration();
  drive.pieces_ = planner.trajectories();
  drive.rides_ = planner.rides();
  for (std::size_t leg = 1; leg < planner.legs(); ++leg) {
    const TimeNs t = planner.leg_start(leg);
    drive.teleports_.push_back(
        {t, drive.pieces_[leg - 1].at(t).T_map_body, drive.pieces_[leg].at(t).T_map_body});
  }
  return drive;
}

MotionState Drive::at(TimeNs t) const {
  t = std::clamp<TimeNs>(t, 0, duration_);
  std::size_t piece = 0;
  while (piece < teleports_.size() && teleports_[piece].t <= t) ++piece;
  return pieces_[piece].at(t);
}

}  // namespace holdfast::simulation
