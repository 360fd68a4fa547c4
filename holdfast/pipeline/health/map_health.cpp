#include "holdfast/pipeline/health/map_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::pipeline {
namespace {

using monitor::Health;
using monitor::Verdict;

// Beyond these a claim misleads.
constexpr double kWrongM = 0.5;
constexpr double kWrongRad = 5.0 * std::numbers::pi / 180.0;
constexpr double kReachM = 6.0;         // of a place: twice the way to the next one
constexpr double kPlaceWorth = 15.0;    // looks: how far a place tells what is usual near it
constexpr float kRaysM = 1500;          // in all: 100 rays of 15 m
constexpr double kBreakLogRatio = 7.0;  // one in ten, where it was one in ten thousand

/// Probability that an error with this sigma, in its worst direction, is greater than `limit`.
double p_beyond(double limit, double sigma) {
  return sigma > 0 ? std::erfc(limit / (sigma * std::numbers::sqrt2)) : 0.0;
}

/// Wrong because it is of another place, or by what the estimate itself says that it may be off.
double p_wrong(const Health& health, const StepReport& report) {
  return 1.0 - (1.0 - health.p_wrong) * (1.0 - p_beyond(kWrongM, report.sigma_trans_m)) *
                   (1.0 - p_beyond(kWrongRad, report.sigma_rot_rad));
}

/// Long rays cost more than they tell: of lines that are longer together than kRaysM, every n-th.
void thin_out(std::vector<monitor::SightLine>& lines) {
  float way_m = 0;
  for (const monitor::SightLine& line : lines) way_m += (line.to - line.from).norm();
  const auto step = static_cast<std::size_t>(std::ceil(way_m / kRaysM));
  if (step <= 1) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < lines.size(); i += step) lines[kept++] = lines[i];
  lines.resize(kept);
}

std::string percent(double seen, double usual) {
  return fmt::format("{:.0f} %, usually {:.0f} %", 100.0 * seen, 100.0 * usual);
}

std::string words(monitor::Witness witness, const Health& health) {
  const monitor::Looks seen = health.seen.value_or(monitor::Looks{});
  const monitor::UsualLooks usual = health.usual.value_or(monitor::UsualLooks{});
  switch (witness) {
    case monitor::Witness::kFitting:
      return "how well paired returns fit: " + percent(seen.fitting, monitor::kUsualFitting);
    case monitor::Witness::kPaired:
      return "returns near a surface of the map: " + percent(seen.paired, usual.paired);
    case monitor::Witness::kThrough:
      return "rays through walls of the map: " + percent(seen.through, usual.through);
    case monitor::Witness::kUnmapped:
      return "returns where the map has nothing: " + percent(seen.unmapped, usual.unmapped);
    case monitor::Witness::kWay: break;
  }
  return "the odometry went another way than the poses in the map";
}

std::vector<Evidence> evidence(const Health& health) {
  std::vector<Evidence> all;
  if (health.onset.log_ratio > 0) {
    all.push_back({"sudden", health.onset.log_ratio,
                   fmt::format("{:.0f} % fewer returns agree with the map than two scans before",
                               100.0 * health.onset.drop)});
  }
  if (health.onset.odometry_broke) {
    all.push_back({"break", kBreakLogRatio, "the odometry says that the robot was carried"});
  }
  for (std::size_t w = 0; w < monitor::kWitnessNames.size(); ++w) {
    if (health.log_ratio[w] == 0) continue;
    all.push_back({monitor::kWitnessNames[w], health.log_ratio[w],
                   words(static_cast<monitor::Witness>(w), health)});
  }
  std::sort(all.begin(), all.end(),
            [](const Evidence& a, const Evidence& b) { return a.log_ratio > b.log_ratio; });
  return all;
}

std::string reason(const Health& health, const std::vector<Evidence>& evidence) {
  const char* what =
      health.verdict == Verdict::kLost ? "the pose is wrong" : "the pose may be wrong";
  if (evidence.empty()) return what;
  return fmt::format("{}: {}", what, evidence.front().text);
}

}  // namespace

void MapHealth::judge(const SceneView& scene, StepReport& report) {
  monitor::HealthInput input;
  input.t = report.pose_time;
  input.way_m = before_ ? (report.T_map_body.translation - before_->translation).norm() : 0.0;
  input.odometry_broke = scene.odometry.broke;
  input.looks = look(scene, report);
  input.usual = usual(report.T_map_body * scene.p_body_lidar);
  input.way_squared_distance = scene.odometry.way_squared_distance;
  before_ = report.T_map_body;
  const Health health = monitor_.judge(input);
  report.p_wrong = p_wrong(health, report);
  if (health.verdict == Verdict::kHealthy) return;
  report.alarm = true;
  report.evidence = evidence(health);
  const bool trusted = report.state == State::kTracking || report.state == State::kDegraded;
  if (health.verdict == Verdict::kLost) {
    report.state = State::kLost;
  } else if (trusted) {
    report.state = State::kSuspect;
  } else {
    return;
  }
  report.reason = reason(health, report.evidence);
}

std::optional<monitor::UsualLooks> MapHealth::usual(const Eigen::Vector3d& p_map_lidar) const {
  const places::Place* place = places_ ? places_->nearest(p_map_lidar, kReachM) : nullptr;
  if (place == nullptr) return std::nullopt;
  const double through = static_cast<double>(place->through_share);
  return monitor::UsualLooks{
      std::min(1.0, static_cast<double>(place->agreeing_share) / monitor::kUsualFitting), through,
      static_cast<double>(place->unmapped_share) / std::max(1e-3, 1.0 - through), kPlaceWorth};
}

std::optional<monitor::Looks> MapHealth::look(const SceneView& scene, const StepReport& report) {
  const std::size_t count = scene.points.size();
  if (count == 0) return std::nullopt;
  const Eigen::Vector3d& anchor = scene.map.anchor();
  const Eigen::Matrix3f R = report.T_map_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f p = (report.T_map_body.translation - anchor).cast<float>();
  const Eigen::Vector3f from = R * scene.p_body_lidar.cast<float>() + p;
  const std::size_t step = std::max<std::size_t>(1, count / static_cast<std::size_t>(config_.rays));
  lines_.clear();
  for (std::size_t i = 0; i < count; i += step) {
    lines_.push_back({from, R * scene.points.points[i] + p});
  }
  thin_out(lines_);
  const auto points = static_cast<double>(count);
  return monitor::looks_of(report.inlier_share * points, report.matches, points,
                           monitor::follow(scene.map, lines_, {}));
}

}  // namespace holdfast::pipeline
