#include "benchmarks/scores/scan_census.hpp"

#include <algorithm>
#include <limits>

namespace holdfast::benchmarks {
namespace {

const registration::FitAtQueryConfig kPrinted;

double share_below(const std::vector<double>& counts, int least) {
  const auto below =
      std::count_if(counts.begin(), counts.end(), [&](double count) { return count < least; });
  return static_cast<double>(below) / static_cast<double>(counts.size());  // NaN for none
}

/// One search: matches at the pose that is given.
registration::FitAtQueryConfig at_once() {
  registration::FitAtQueryConfig config = kPrinted;
  config.max_searches = 1;
  return config;
}

/// Features where they truly are, in the map frame and relative to `origin`.
class Placing {
 public:
  Placing(const simulation::Simulation& drive, const Scan& scan, const Eigen::Vector3d& origin)
      : drive_(drive), scan_(scan), origin_(origin) {}

  std::vector<Eigen::Vector3f> place(const std::vector<features::Feature>& features) const {
    std::vector<Eigen::Vector3f> points;
    for (const features::Feature& feature : features) {
      const TimeNs t = scan_.stamp + scan_.points[feature.index].time_offset_ns;
      const SE3 T_map_lidar = drive_.truth_at(t) * drive_.options().lidar.T_body_lidar;
      const Eigen::Vector3d p = T_map_lidar * feature.position.cast<double>();
      points.push_back((p - origin_).cast<float>());
    }
    return points;
  }

 private:
  const simulation::Simulation& drive_;
  const Scan& scan_;
  const Eigen::Vector3d& origin_;
};

double moving_share(const std::vector<simulation::TrueReturn>& truth) {
  const auto moving =
      std::count_if(truth.begin(), truth.end(), [](const auto& hit) { return hit.moving; });
  return truth.empty() ? 0 : static_cast<double>(moving) / static_cast<double>(truth.size());
}

}  // namespace

double ScanCounts::few_edges() const { return share_below(edge_matches, kPrinted.least_edges); }
double ScanCounts::few_planes() const { return share_below(plane_matches, kPrinted.least_planes); }

double ScanCounts::few_of_either() const {
  std::size_t few = 0;
  for (std::size_t i = 0; i < scans(); ++i) {
    few += edge_matches[i] < kPrinted.least_edges || plane_matches[i] < kPrinted.least_planes;
  }
  return static_cast<double>(few) / static_cast<double>(scans());
}

ScanCensus::ScanCensus(SurveyedDrive& drive, const Eigen::Vector3d& origin,
                       registration::FitAtQuery matching)
    : drive_(&drive), origin_(origin), matching_(std::move(matching)) {}

Result<ScanCensus> ScanCensus::create(SurveyedDrive& drive) {
  auto info = map::read_map_info(drive.map_dir);
  if (!info) return info.error();
  auto clouds = registration::classify_points(drive.map_dir);
  if (!clouds) return clouds.error();
  return ScanCensus(drive, info->origin, registration::FitAtQuery(std::move(*clouds), at_once()));
}

void ScanCensus::add(const Scan& scan, const features::Features& found,
                     const std::vector<simulation::TrueReturn>& truth, ScanCounts& counts) const {
  const Placing placing(*drive_->simulation, scan, origin_);
  const registration::FeatureClouds placed{placing.place(found.edges), placing.place(found.planes)};
  const auto matched = matching_.align(placed, SE3{});
  counts.returns.push_back(static_cast<double>(scan.points.size()));
  counts.edge_matches.push_back(matched.edges);
  counts.plane_matches.push_back(matched.planes);
  counts.occluded.push_back(moving_share(truth));
}

}  // namespace holdfast::benchmarks
