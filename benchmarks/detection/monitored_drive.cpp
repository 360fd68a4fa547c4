#include "benchmarks/detection/monitored_drive.hpp"

#include <fmt/format.h>

#include <numbers>

#include "benchmarks/drives/localization.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr double kMovingMS = 0.1;
constexpr double kChangedShare = 0.2;

bool is_wrong(const SE3& claimed, const SE3& truth) {
  const evaluation::PoseTolerance limit = evaluation::EvaluationOptions{}.misleading;
  return (claimed.translation - truth.translation).norm() > limit.trans_m ||
         so3::angle_between(claimed.rotation, truth.rotation) * 180.0 / std::numbers::pi >
             limit.rot_deg;
}

ScanHealth health_of(const StepReport& step, const simulation::Simulation& drive,
                     const ScanHealth* before) {
  ScanHealth scan;
  const SE3 truth = drive.truth_at(step.pose_time);
  scan.t = step.pose_time;
  scan.wrong = is_wrong(step.T_map_body, truth);
  scan.trusted = step.state == State::kTracking || step.state == State::kDegraded;
  if (before != nullptr) {
    const double way_m = (truth.translation - drive.truth_at(before->t).translation).norm();
    scan.moving = way_m > kMovingMS * to_seconds(scan.t - before->t);
  }
  scan.alarm = step.alarm;
  scan.p_wrong = step.p_wrong;
  scan.T_map_body = step.T_map_body;
  scan.T_map_predicted = step.T_map_predicted;
  scan.mean_residual_m = step.mean_abs_residual_m;
  scan.matches = step.matches;
  return scan;
}

/// At the end of the first scan.
SE3 initial_pose(const DetectionCase& what, simulation::Simulation& drive, double duration_s) {
  const SE3 truth = drive.initial_pose();
  if (what.mishap != Mishap::kWrongStart) return truth;
  if (what.start_share >= 0) {
    return drive.truth_at(drive.start_time() + from_seconds(what.start_share * duration_s));
  }
  return {truth.rotation * so3::exp(Eigen::Vector3d(0, 0, std::numbers::pi)), truth.translation};
}

}  // namespace

std::vector<DetectionCase> detection_cases(double duration_s) {
  const double middle_s = 0.5 * duration_s;
  const auto at = [&](const char* name) { return fmt::format("{}@{}", name, middle_s); };
  const auto lasting = [&](const char* name, double share) {
    return fmt::format("{}@{}+{}", name, middle_s, share * duration_s);
  };
  return {
      {"quiet", Mishap::kNone, ""},
      {"changed world", Mishap::kNone, "", kChangedShare},
      {"crowd", Mishap::kNone, lasting("crowd", 0.2)},
      {"blackout", Mishap::kNone, lasting("lidar_off", 0.3)},
      {"bias jump", Mishap::kNone, at("imu_bias_jump")},
      {"kidnap", Mishap::kKidnap, at("kidnap")},
      {"kidnap, changed world", Mishap::kKidnap, at("kidnap"), kChangedShare},
      {"wrong start, elsewhere", Mishap::kWrongStart, "", 0, 0.5},
      {"wrong start, turned", Mishap::kWrongStart, "", 0, -1.0},
  };
}

Result<MonitoredDrive> monitor_drive(const DetectionCase& what, const DriveSpec& spec,
                                     const SurveyedDrive& surveyed) {
  DriveSpec its = spec;
  its.changed_share = what.changed_share;
  if (!what.event.empty()) {
    const auto event = simulation::parse_event(what.event);
    if (!event) return event.error();
    its.events = {*event};
  }
  auto drive = make_drive(its);
  if (!drive) return drive.error();
  const auto steps = localize(**drive, surveyed.config, surveyed.map_dir,
                              initial_pose(what, **drive, spec.duration_s));
  if (!steps) return steps.error();
  MonitoredDrive result;
  result.what = what.name;
  result.mishap = what.mishap;
  if (what.mishap == Mishap::kKidnap) {
    result.event = (*drive)->start_time() + its.events.front().start + its.events.front().duration;
  }
  for (const StepReport& step : *steps) {
    if (step.state == State::kInitializing) continue;
    result.scans.push_back(
        health_of(step, **drive, result.scans.empty() ? nullptr : &result.scans.back()));
  }
  return result;
}

}  // namespace holdfast::benchmarks
