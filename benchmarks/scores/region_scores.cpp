#include "benchmarks/scores/region_scores.hpp"

#include <algorithm>

namespace holdfast::benchmarks {
namespace {

using evaluation::ScanRecord;
using simulation::Region;

bool holds(const Region& region, const Eigen::Vector3d& p_map) {
  const Eigen::Vector2d p = p_map.head<2>();
  return (p - region.min).minCoeff() >= 0 && (region.max - p).minCoeff() >= 0;
}

void add(const ScanRecord& scan, double way_m, RegionScore& score) {
  const evaluation::PoseTolerance wrong = evaluation::EvaluationOptions{}.misleading;
  ++score.scans;
  score.path_m += way_m;
  score.trusted.add(scan.claimed && evaluation::status_is_trusted(scan.status));
  score.misleading.add(evaluation::is_misleading(scan, wrong));
  if (scan.has_error()) score.trans_m.push_back(scan.trans_error_m);
}

}  // namespace

std::vector<RegionScore> score_regions(const std::vector<Region>& regions,
                                       const std::vector<ScanRecord>& series) {
  std::vector<RegionScore> scores(regions.size() + 2);
  for (std::size_t i = 0; i < regions.size(); ++i) scores[i].name = regions[i].name;
  scores[regions.size()].name = "elsewhere";
  scores.back().name = "whole drive";
  double before_m = 0;
  for (const ScanRecord& scan : series) {
    if (!scan.truth.known()) continue;
    const double way_m = scan.truth.path_m - before_m;
    before_m = scan.truth.path_m;
    if (!scan.counts) continue;
    const auto region = std::find_if(regions.begin(), regions.end(), [&](const Region& r) {
      return holds(r, scan.truth.T_map_body.translation);
    });
    add(scan, way_m, scores[static_cast<std::size_t>(region - regions.begin())]);
    add(scan, way_m, scores.back());
  }
  return scores;
}

}  // namespace holdfast::benchmarks
