#include <fmt/format.h>

#include <array>
#include <numbers>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/surveyed_drive.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/features/features.hpp"

namespace holdfast::benchmarks {
namespace {

using features::Feature;
using simulation::TrueReturn;

/// Counts a scan as the article gives them (4.1.1); 0: not in the article.
struct ScenarioRow {
  const char* name;
  int planes, edges;
};
constexpr std::array<ScenarioRow, 5> kScenarios = {{{"corridor", 4200, 1800},
                                                    {"office", 2100, 1200},
                                                    {"hall", 600, 300},
                                                    {"warehouse", 0, 0},
                                                    {"yard", 0, 0}}};
constexpr std::array kSmoothness = {"printed", "log", "fitted"};

constexpr double kNearEdgeM = 0.15;
constexpr double kNormalDeg = 5.0;
constexpr float kCoveredM = 0.1F;  // a planar point is found when a feature of its ring is so near
constexpr std::size_t kLeastRun = 3;
constexpr std::size_t kJudgedEach = 5;  // of the scans: the truth is cast again for each point

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);  // NaN for none
}

/// What one way of finding features came to, over all scans of a scenario.
struct Score {
  std::size_t scans = 0, judged = 0;
  std::size_t edges = 0, planes = 0;             ///< features of all scans
  std::size_t judged_edges = 0, near_edge = 0;   ///< edge features; those at a true edge
  std::size_t crossings = 0, crossings_met = 0;  ///< runs of a ring at a true edge
  std::size_t judged_planes = 0, clear_planes = 0, right_planes = 0;
  std::size_t flat_points = 0, flat_points_met = 0;
  std::vector<double> normal_deg, ms;

  double edge_precision() const { return share(near_edge, judged_edges); }
  double edge_recall() const { return share(crossings_met, crossings); }
  /// NaN where the features have no normals.
  double plane_precision() const {
    return share(right_planes, normal_deg.empty() ? 0 : judged_planes);
  }
  double plane_recall() const { return share(flat_points_met, flat_points); }
};

/// A scan with what is true of it, its points in the order of their rings.
struct JudgedScan {
  const Scan* scan;
  const std::vector<TrueReturn>* truth;
  std::vector<std::vector<std::uint32_t>> rings;
  std::vector<std::uint32_t> place;  ///< of each point in its ring

  JudgedScan(const Scan& s, const std::vector<TrueReturn>& t) : scan(&s), truth(&t) {
    for (std::uint32_t i = 0; i < s.points.size(); ++i) {
      const std::uint16_t ring = s.points[i].ring;
      if (rings.size() <= ring) rings.resize(ring + 1U);
      place.push_back(static_cast<std::uint32_t>(rings[ring].size()));
      rings[ring].push_back(i);
    }
  }
  Eigen::Vector3f point(std::uint32_t i) const {
    const ScanPoint& p = scan->points[i];
    return {p.x, p.y, p.z};
  }
  bool at_edge(std::uint32_t i) const { return (*truth)[i].edge_distance_m < kNearEdgeM; }
  bool flat(std::uint32_t i) const {
    const TrueReturn& hit = (*truth)[i];
    return !at_edge(i) && !hit.moving && hit.is_surface();
  }
};

void judge_edges(const JudgedScan& judged, const std::vector<Feature>& edges, Score& score) {
  std::vector<char> is_edge(judged.place.size(), 0);
  for (const Feature& edge : edges) {
    is_edge[edge.index] = 1;
    score.near_edge += judged.at_edge(edge.index);
  }
  score.judged_edges += edges.size();
  for (const auto& ring : judged.rings) {
    std::size_t run = 0;
    bool met = false;
    for (std::size_t k = 0; k <= ring.size(); ++k) {
      if (k < ring.size() && judged.at_edge(ring[k])) {
        ++run;
        met = met || is_edge[ring[k]] != 0;
        continue;
      }
      score.crossings += run >= kLeastRun;
      score.crossings_met += run >= kLeastRun && met;
      run = 0;
      met = false;
    }
  }
}

/// Marks the points of the feature's ring that lie near it.
void mark_around(const JudgedScan& judged, std::uint32_t index, std::vector<char>& met) {
  const auto& ring = judged.rings[judged.scan->points[index].ring];
  const Eigen::Vector3f p = judged.point(index);
  const auto mark = [&](std::size_t k) {
    if ((judged.point(ring[k]) - p).norm() > kCoveredM) return false;
    met[ring[k]] = 1;
    return true;
  };
  for (std::size_t k = judged.place[index]; k < ring.size() && mark(k);) ++k;
  for (std::size_t k = judged.place[index]; k > 0 && mark(k - 1);) --k;
}

/// Angle between the feature's normal and the true one; < 0 where the feature has none.
double normal_error_deg(const JudgedScan& judged, const Feature& plane,
                        const simulation::Simulation& drive) {
  if (plane.axis.isZero()) return -1;
  const TimeNs t = judged.scan->stamp + judged.scan->points[plane.index].time_offset_ns;
  const Eigen::Quaterniond R =
      drive.truth_at(t).rotation * drive.options().lidar.T_body_lidar.rotation;
  const double cosine =
      (R * plane.axis.cast<double>()).dot((*judged.truth)[plane.index].normal_map);
  return std::acos(std::clamp(std::abs(cosine), 0.0, 1.0)) * 180 / std::numbers::pi;
}

void judge_planes(const JudgedScan& judged, const std::vector<Feature>& planes,
                  const simulation::Simulation& drive, Score& score) {
  std::vector<char> met(judged.place.size(), 0);
  for (const Feature& plane : planes) {
    const bool clear = judged.flat(plane.index);
    const double off = normal_error_deg(judged, plane, drive);
    score.clear_planes += clear;
    score.right_planes += clear && off >= 0 && off < kNormalDeg;
    if (clear && off >= 0) score.normal_deg.push_back(off);
    mark_around(judged, plane.index, met);
  }
  score.judged_planes += planes.size();
  for (std::uint32_t i = 0; i < met.size(); ++i) {
    score.flat_points += judged.flat(i);
    score.flat_points_met += judged.flat(i) && met[i] != 0;
  }
}

using Scores = std::array<Score, kSmoothness.size()>;

/// Runs all extractors over a drive; each has seen a scan before its time counts.
Status add_drive(const DriveSpec& spec, Scores& scores) {
  auto drive = make_drive(spec);
  if (!drive) return drive.error();
  std::vector<features::FeatureExtractor> extractors;
  for (const char* smoothness : kSmoothness) {
    features::FeatureConfig config;
    config.smoothness = smoothness;
    extractors.emplace_back(config, (*drive)->options().lidar.range_sigma_m);
  }
  features::Features found;
  for (std::size_t number = 0;;) {
    auto event = (*drive)->next();
    if (!event) return event.error();
    if (!event->has_value()) return Done{};
    const Scan* scan = std::get_if<Scan>(&**event);
    if (scan == nullptr) continue;
    const bool judge = number++ % kJudgedEach == 1;
    const auto truth = judge ? (*drive)->true_geometry(*scan) : std::vector<TrueReturn>{};
    for (std::size_t k = 0; k < extractors.size(); ++k) {
      const double start = thread_cpu_ms();
      extractors[k].extract(*scan, found);
      if (number > 1) scores[k].ms.push_back(thread_cpu_ms() - start);
      ++scores[k].scans;
      scores[k].edges += found.edges.size();
      scores[k].planes += found.planes.size();
      if (!judge) continue;
      const JudgedScan judged(*scan, truth);
      judge_edges(judged, found.edges, scores[k]);
      judge_planes(judged, found.planes, **drive, scores[k]);
    }
  }
}

nlohmann::ordered_json json_of(const char* smoothness, const Score& s) {
  return {{"smoothness", smoothness},
          {"scans", s.scans},
          {"edges_per_scan", known(share(s.edges, s.scans))},
          {"planes_per_scan", known(share(s.planes, s.scans))},
          {"edge_precision", known(s.edge_precision())},
          {"edge_recall", known(s.edge_recall())},
          {"plane_clear_of_edges", known(share(s.clear_planes, s.judged_planes))},
          {"plane_precision", known(s.plane_precision())},
          {"plane_recall", known(s.plane_recall())},
          {"normal_median_deg", known(distribution_of(s.normal_deg).p50)},
          {"ms", json_of(distribution_of(s.ms))}};
}

std::string article_text(int count) { return count == 0 ? "-" : fmt::format("{}", count); }

void add_row(const ScenarioRow& scenario, const char* smoothness, const Score& s, Table& table) {
  using namespace evaluation;
  table.add_row(
      {fmt::format("{}, {}", scenario.name, smoothness), count_text(share(s.edges, s.scans)),
       article_text(scenario.edges), share_text(s.edge_precision()), share_text(s.edge_recall()),
       count_text(share(s.planes, s.scans)), article_text(scenario.planes),
       share_text(share(s.clear_planes, s.judged_planes)), share_text(s.plane_precision()),
       share_text(s.plane_recall()), milliseconds_text(distribution_of(s.ms).p50)});
}

}  // namespace

Result<BenchReport> measure_features(const BenchOptions& options) {
  BenchReport report;
  Table table({"scenario, smoothness", "edges", "article", "edges: precision", "recall", "planes",
               "article", "planes: clear of edges", "and normal right", "recall", "time, p50"});
  double done = 0;
  for (const ScenarioRow& scenario : kScenarios) {
    Scores scores;
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      options.progress(done++ / static_cast<double>(kScenarios.size() * options.seeds.count()),
                       fmt::format("{}, seed {}", scenario.name, seed));
      const DriveSpec spec{scenario.name, seed, options.duration_s, options.threads};
      if (auto added = add_drive(spec, scores); !added) return added.error();
    }
    nlohmann::ordered_json ways;
    for (std::size_t k = 0; k < scores.size(); ++k) {
      ways.push_back(json_of(kSmoothness[k], scores[k]));
      add_row(scenario, kSmoothness[k], scores[k], table);
    }
    report.data["results"].push_back({{"scenario", scenario.name}, {"features", ways}});
  }
  report.markdown = table.markdown();
  report.markdown += fmt::format(
      "\nCounts are means per scan, beside those of the article (4.1.1). An edge is right within "
      "{} m of a true edge; its recall counts runs of a ring that close to a true edge. A plane is "
      "clear when it is farther than that from all edges and nobody walking, and right when its "
      "normal is also within {} degrees (printed and log give no normals); its recall counts "
      "points clear of edges with a feature of their ring within {} m.\n",
      kNearEdgeM, kNormalDeg, kCoveredM);
  return report;
}

}  // namespace holdfast::benchmarks
