#include <fmt/format.h>

#include <array>
#include <numbers>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "benchmarks/scores/scan_census.hpp"
#include "evaluation/result/number_text.hpp"
#include "evaluation/statistics.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/features/features.hpp"

namespace holdfast::benchmarks {
namespace {

using features::Feature;
using simulation::TrueReturn;

/// What the article says of its scenarios (4.1.1): features a scan, the share of scans with fewer
/// matches than N_E or N_F, the greatest occlusion by people. 0: not in the article.
struct ScenarioRow {
  std::string name;
  int planes = 0, edges = 0;
  double few_matches = 0, occluded = 0;
};
const std::array kScenarios = {
    ScenarioRow{"corridor", 4200, 1800, 0, 0}, ScenarioRow{"office", 2100, 1200, 0, 0.35},
    ScenarioRow{"hall", 600, 300, 0.183, 0}, ScenarioRow{"warehouse"}, ScenarioRow{"yard"}};
constexpr std::array kSmoothness = {"printed", "log", "fitted"};
constexpr std::size_t kMatched = 1;  // log: the print itself yields no planes

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

/// What the drives of a scenario came to.
struct Results {
  std::array<Score, kSmoothness.size()> scores;
  ScanCounts counts;
};

std::vector<features::FeatureExtractor> all_extractors(double range_sigma_m) {
  std::vector<features::FeatureExtractor> extractors;
  for (const char* smoothness : kSmoothness) {
    features::FeatureConfig config;
    config.smoothness = smoothness;
    extractors.emplace_back(config, range_sigma_m);
  }
  return extractors;
}

/// Runs all extractors over the scans of a drive; each has seen a scan before its time counts.
class Measurement {
 public:
  Measurement(const simulation::Simulation& drive, const ScanCensus& census, Results& results)
      : drive_(drive),
        census_(census),
        results_(results),
        extractors_(all_extractors(drive.options().lidar.range_sigma_m)) {}

  void add(const Scan& scan, const std::vector<TrueReturn>& truth) {
    const bool judge = number_++ % kJudgedEach == 1;
    for (std::size_t k = 0; k < extractors_.size(); ++k) {
      Score& score = results_.scores[k];
      const double start = thread_cpu_ms();
      extractors_[k].extract(scan, found_);
      if (number_ > 1) score.ms.push_back(thread_cpu_ms() - start);
      ++score.scans;
      score.edges += found_.edges.size();
      score.planes += found_.planes.size();
      if (k == kMatched) census_.add(scan, found_, truth, results_.counts);
      if (!judge) continue;
      const JudgedScan judged(scan, truth);
      judge_edges(judged, found_.edges, score);
      judge_planes(judged, found_.planes, drive_, score);
    }
  }

 private:
  const simulation::Simulation& drive_;
  const ScanCensus& census_;
  Results& results_;
  std::vector<features::FeatureExtractor> extractors_;
  features::Features found_;
  std::size_t number_ = 0;
};

Status add_drive(const DriveSpec& spec, Results& results) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto surveyed = survey_drive(spec, scratch->path());
  if (!surveyed) return surveyed.error();
  simulation::Simulation& drive = *surveyed->simulation;
  const auto census = ScanCensus::create(*surveyed);
  if (!census) return census.error();
  Measurement measurement(drive, *census, results);
  while (true) {
    auto event = drive.next();
    if (!event) return event.error();
    if (!event->has_value()) return Done{};
    const Scan* scan = std::get_if<Scan>(&**event);
    if (scan != nullptr) measurement.add(*scan, drive.true_geometry(*scan));
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

nlohmann::ordered_json json_of(const ScanCounts& counts) {
  return {{"returns_median", known(evaluation::median(counts.returns))},
          {"edge_matches_median", known(evaluation::median(counts.edge_matches))},
          {"plane_matches_median", known(evaluation::median(counts.plane_matches))},
          {"few_edge_matches", known(counts.few_edges())},
          {"few_plane_matches", known(counts.few_planes())},
          {"few_matches", known(counts.few_of_either())},
          {"occluded_median", known(evaluation::median(counts.occluded))},
          {"occluded_worst", known(largest(counts.occluded))}};
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

void add_row(const ScenarioRow& scenario, const ScanCounts& counts, Table& table) {
  using namespace evaluation;
  const auto printed = [](double share) { return share > 0 ? share_text(share) : "-"; };
  table.add_row({scenario.name, count_text(median(counts.returns)),
                 count_text(median(counts.edge_matches)), count_text(median(counts.plane_matches)),
                 share_text(counts.few_edges()), share_text(counts.few_planes()),
                 share_text(counts.few_of_either()), printed(scenario.few_matches),
                 share_text(median(counts.occluded)), share_text(largest(counts.occluded)),
                 printed(scenario.occluded)});
}

/// Those that are asked for, or all.
std::vector<ScenarioRow> rows_of(const BenchOptions& options) {
  if (options.scenarios.empty()) return {kScenarios.begin(), kScenarios.end()};
  std::vector<ScenarioRow> rows;
  for (const std::string& name : options.scenarios) {
    const auto known = std::find_if(kScenarios.begin(), kScenarios.end(),
                                    [&](const ScenarioRow& row) { return row.name == name; });
    rows.push_back(known != kScenarios.end() ? *known : ScenarioRow{name});
  }
  return rows;
}

Status add_drives(const ScenarioRow& scenario, const BenchOptions& options, Results& results) {
  for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
    const DriveSpec spec{scenario.name, seed, options.duration_s, options.threads};
    if (auto added = add_drive(spec, results); !added) return added;
  }
  return Done{};
}

nlohmann::ordered_json json_of(const ScenarioRow& scenario, const Results& results) {
  nlohmann::ordered_json ways;
  for (std::size_t k = 0; k < kSmoothness.size(); ++k) {
    ways.push_back(json_of(kSmoothness[k], results.scores[k]));
  }
  return {{"scenario", scenario.name}, {"features", ways}, {"scans", json_of(results.counts)}};
}

}  // namespace

Result<BenchReport> measure_features(const BenchOptions& options) {
  BenchReport report;
  Table table({"scenario, smoothness", "edges", "article", "edges: precision", "recall", "planes",
               "article", "planes: clear of edges", "and normal right", "recall", "time, p50"});
  Table scans({"scenario", "returns, median", "edge matches", "plane matches", "too few edges",
               "planes", "either", "article", "occluded, median", "worst", "article"});
  const auto rows = rows_of(options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ScenarioRow& scenario = rows[i];
    options.progress(static_cast<double>(i) / static_cast<double>(rows.size()), scenario.name);
    Results results;
    if (auto added = add_drives(scenario, options, results); !added) return added.error();
    for (std::size_t k = 0; k < kSmoothness.size(); ++k) {
      add_row(scenario, kSmoothness[k], results.scores[k], table);
    }
    add_row(scenario, results.counts, scans);
    report.data["results"].push_back(json_of(scenario, results));
  }
  report.markdown = table.markdown();
  report.markdown += fmt::format(
      "\nCounts are means per scan, beside those of the article (4.1.1). An edge is right within "
      "{} m of a true edge; its recall counts runs of a ring that close to a true edge. A plane is "
      "clear when it is farther than that from all edges and nobody walking, and right when its "
      "normal is also within {} degrees (printed and log give no normals); its recall counts "
      "points clear of edges with a feature of their ring within {} m.\n",
      kNearEdgeM, kNormalDeg, kCoveredM);
  report.markdown += fmt::format(
      "\n{}\nMatches, medians of a scan, and the shares of scans with too few of them: features by "
      "log at their true places, matched as printed (3.2.2) with the lines and planes of the "
      "drive's survey; too few are less than 10 edges, less than 20 planes. Occluded: share of a "
      "scan's returns that come from somebody walking.\n",
      scans.markdown());
  return report;
}

}  // namespace holdfast::benchmarks
