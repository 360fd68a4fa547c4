#include "benchmarks/relocalization/lost_moments.hpp"

#include <deque>
#include <numbers>
#include <set>

#include "holdfast/core/random.hpp"
#include "simulation/aliases/aliases.hpp"

namespace holdfast::benchmarks {
namespace {

/// The numbers of the scans that are asked about.
std::set<std::size_t> draw_scans(const simulation::Simulation& drive, int moments) {
  RandomStream random(drive.options().seed, "lost moments");
  std::set<std::size_t> numbers;
  const std::size_t scans = drive.scan_count();
  const std::size_t first = kScansOfAMoment;
  if (scans <= first) return numbers;
  for (int i = 0; i < 4 * moments && numbers.size() < static_cast<std::size_t>(moments); ++i) {
    numbers.insert(first + random.below(scans - first));
  }
  return numbers;
}

/// Adds a scan's points in the frame of the body at `now`.
void add_points(const simulation::Simulation& drive, const Scan& scan, const SE3& T_body_lidar,
                const std::vector<std::uint32_t>& selected, TimeNs now,
                registration::BodyPoints& out) {
  const SE3 T_now_map = drive.truth_at(now).inverse();
  for (const std::uint32_t i : selected) {
    const ScanPoint& point = scan.points[i];
    const TimeNs t = scan.stamp + point.time_offset_ns;
    const SE3 T_now_lidar = T_now_map * drive.truth_at(t) * T_body_lidar;
    const Eigen::Vector3d p = T_now_lidar * Eigen::Vector3d(point.x, point.y, point.z);
    out.points.push_back(p.cast<float>());
    out.age_s.push_back(static_cast<float>(to_seconds(t - now)));
  }
}

Eigen::Vector3d gravity_in_body(const SE3& T_map_body, double sigma_deg, RandomStream& random) {
  const double sigma = sigma_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d tilt(random.normal(0, sigma), random.normal(0, sigma), 0);
  return so3::exp(tilt) * (T_map_body.rotation.conjugate() * -Eigen::Vector3d::UnitZ());
}

/// Where else the robot may as well be at `t`.
std::vector<SE3> aliases_at(const simulation::Simulation& drive,
                            const std::vector<simulation::AliasedStretch>& stretches, TimeNs t) {
  std::vector<SE3> poses;
  for (const simulation::AliasedStretch& stretch : stretches) {
    if (t < stretch.t0 || t > stretch.t1) continue;
    const SE3 way = drive.truth_at(stretch.t0).inverse() * drive.truth_at(t);
    for (const SE3& pose : stretch.poses) poses.push_back(pose * way);
  }
  return poses;
}

}  // namespace

Result<std::vector<LostMoment>> lost_moments(simulation::Simulation& drive, const SE3& T_body_lidar,
                                             const preprocess::ScanSelectionConfig& selection,
                                             const MomentOptions& options) {
  const std::set<std::size_t> asked = draw_scans(drive, options.moments);
  std::vector<simulation::AliasedStretch> stretches;
  if (options.aliases) stretches = simulation::find_aliases(drive, {});
  RandomStream random(drive.options().seed, "lost moments, gravity");
  std::vector<LostMoment> moments;
  std::deque<Scan> recent;
  std::vector<std::uint32_t> selected;
  for (std::size_t number = 0;;) {
    auto event = drive.next();
    if (!event) return event.error();
    if (!event->has_value()) return moments;
    const auto* scan = std::get_if<Scan>(&**event);
    if (scan == nullptr) continue;
    recent.push_back(drive.in_true_time(*scan));
    if (recent.size() > kScansOfAMoment) recent.pop_front();
    if (!asked.contains(number++)) continue;
    LostMoment moment;
    moment.t = recent.back().end_time;
    moment.T_map_body = drive.truth_at(moment.t);
    moment.aliases = aliases_at(drive, stretches, moment.t);
    moment.scan.gravity_body = gravity_in_body(moment.T_map_body, options.tilt_sigma_deg, random);
    moment.scan.p_body_lidar = T_body_lidar.translation;
    moment.scans = moment.scan;
    for (const Scan& one : recent) {
      preprocess::select_points(one, selection, number, selected);
      add_points(drive, one, T_body_lidar, selected, moment.t, moment.scans.points);
      if (&one == &recent.back()) {
        add_points(drive, one, T_body_lidar, selected, moment.t, moment.scan.points);
      }
    }
    moments.push_back(std::move(moment));
  }
}

}  // namespace holdfast::benchmarks
