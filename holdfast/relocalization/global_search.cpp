#include "holdfast/relocalization/global_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/places/places.hpp"
#include "holdfast/relocalization/judging/judge.hpp"
#include "holdfast/relocalization/judging/prospects.hpp"
#include "holdfast/relocalization/occupancy/occupancy_pyramid.hpp"
#include "holdfast/relocalization/occupancy/standpoints.hpp"
#include "holdfast/relocalization/wide/spread_points.hpp"
#include "holdfast/relocalization/wide/wide_search.hpp"

namespace holdfast::relocalization {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kGrownM = 0.1F;
constexpr float kAsideM = 6.0F;
constexpr std::size_t kLeastPoints = 40;  // spread ones; fewer say too little
constexpr std::size_t kRoughPoints = 160;
constexpr std::size_t kFinePoints = 400;
constexpr std::size_t kMostFine = 60;
constexpr std::size_t kFullPoints = 2500;
constexpr std::size_t kMostRefined = 20;
constexpr double kFocusM = 60.0;
constexpr double kWideWork = 8.0;  // look-ups of the grid that take the time of a pair
constexpr double kMostTilt = 3.0 * kGravitySigmaRad;
constexpr int kLeastYaws = 60, kMostYaws = 480;

/// Every n-th point, so that about `most` are left.
registration::BodyPoints thinned(const registration::BodyPoints& points, std::size_t most) {
  registration::BodyPoints few;
  const std::size_t step = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  for (std::size_t i = step / 2; i < points.size(); i += step) {
    few.points.push_back(points.points[i]);
    few.age_s.push_back(points.age_s[i]);
  }
  return few;
}

/// Steps of yaw that move most of the points by less than a cell.
int yaw_steps(const std::vector<Vector3f>& points) {
  std::vector<float> ranges;
  for (const Vector3f& p : points) ranges.push_back(p.head<2>().norm());
  const auto far = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() * 8 / 10);
  std::nth_element(ranges.begin(), far, ranges.end());
  const double steps = 2 * std::numbers::pi * static_cast<double>(*far) / double{kCellM};
  return std::clamp(static_cast<int>(std::ceil(steps)), kLeastYaws, kMostYaws);
}

Sight sight_of(const SearchQuery& query, std::size_t most) {
  return {thinned(query.points, most), query.gravity_body, query.p_body_lidar, query.range_sigma_m};
}

}  // namespace

struct GlobalSearch::Parts {
  SearchConfig config;
  map::PriorMap map;
  places::Places places;
  OccupancyPyramid occupancy;
  Standpoints standpoints;

  std::vector<Prospect> search_widely(const SearchQuery& query, SearchReport& report) const;
  Status rank(const SearchQuery& query, Refiner& refiner, std::vector<Prospect>& prospects);
  Status look_closely(const Sight& sight, const std::vector<Prospect>& prospects, Refiner& refiner,
                      SearchReport& report);
};

GlobalSearch::GlobalSearch(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
GlobalSearch::GlobalSearch(GlobalSearch&& other) noexcept = default;
GlobalSearch& GlobalSearch::operator=(GlobalSearch&& other) noexcept = default;
GlobalSearch::~GlobalSearch() = default;

Result<GlobalSearch> GlobalSearch::create(const std::filesystem::path& dir,
                                          const SearchConfig& config) {
  auto map = map::PriorMap::open(dir);
  if (!map) return map.error();
  auto places = places::Places::open(dir);
  if (!places) return places.error();
  if (places->all().empty()) {
    return Error{fmt::format("{}: a map without places, which a search needs: import it again",
                             dir.string())};
  }
  constexpr float kBlockM = kCellM * (1 << OccupancyPyramid::kLevels);
  const float margin_m = static_cast<float>(config.reach_m) + kAsideM + kBlockM;
  auto occupancy = OccupancyPyramid::of_map(dir, map->info(), kGrownM, margin_m);
  if (!occupancy) return occupancy.error();
  Standpoints standpoints(
      places->all(), *occupancy,
      {kAsideM, static_cast<float>(config.lowest_m), static_cast<float>(config.highest_m)});
  return GlobalSearch(std::make_unique<Parts>(Parts{
      config, std::move(*map), std::move(*places), std::move(*occupancy), std::move(standpoints)}));
}

/// The modes of the gridded score, as poses.
std::vector<Prospect> GlobalSearch::Parts::search_widely(const SearchQuery& query,
                                                         SearchReport& report) const {
  const Quaterniond R_level_body =
      Quaterniond::FromTwoVectors(query.gravity_body, -Vector3d::UnitZ());
  const Quaterniond R_map_level =
      Quaterniond::FromTwoVectors(-Vector3d::UnitZ(), map.info().gravity_map);
  std::vector<Vector3f> level;
  level.reserve(query.points.size());
  const Eigen::Matrix3f R = R_level_body.toRotationMatrix().cast<float>();
  const Vector3f lidar = query.p_body_lidar.cast<float>();
  for (const Vector3f& p : query.points.points) level.push_back(R * (p - lidar));
  SpreadOptions spread;
  spread.reach_m = static_cast<float>(config.reach_m);
  const std::vector<Vector3f> points = spread_points(level, spread);
  if (points.size() < kLeastPoints) {
    report.outcome = SearchOutcome::kTooPoor;
    report.reason =
        fmt::format("{} well spread returns, at least {} expected", points.size(), kLeastPoints);
    return {};
  }
  std::vector<int> lane_z;
  for (int word = 0; word < standpoints.words(); ++word) lane_z.push_back(standpoints.low_z(word));
  const TurnedPoints turned(points, yaw_steps(points), R_map_level.cast<float>(), occupancy,
                            lane_z);
  WideOptions options;
  options.most_work = static_cast<std::uint64_t>(config.most_work);
  const WideResult found = WideSearch(occupancy, standpoints, turned, options).run(points.size());
  report.work += found.work;
  if (found.out_of_work) {
    report.outcome = SearchOutcome::kOutOfWork;
    report.reason = "the limit of work was reached before all of the map was searched";
    return {};
  }
  if (found.too_alike) {
    report.outcome = SearchOutcome::kAmbiguous;
    report.reason = "what is seen looks like too many places of the map";
    return {};
  }
  std::vector<Prospect> prospects;
  for (const Mode& mode : found.modes) {
    const Vector3d cell(mode.cell.x + 0.5, mode.cell.y + 0.5, mode.cell.z + 0.5);
    const Eigen::AngleAxisd yaw(turned.yaw(mode.yaw), Vector3d::UnitZ());
    const Quaterniond R_map_body = (R_map_level * yaw * R_level_body).normalized();
    const Vector3d p = map.info().origin + double{kCellM} * cell;
    prospects.push_back({{R_map_body, p - R_map_body * query.p_body_lidar},
                         {},
                         static_cast<double>(mode.hits) / found.points,
                         0});
  }
  return prospects;
}

/// Refines all modes, at first with few points; the best first, copies left out.
Status GlobalSearch::Parts::rank(const SearchQuery& query, Refiner& refiner,
                                 std::vector<Prospect>& prospects) {
  const Sight few = sight_of(query, kRoughPoints);
  const Sight more = sight_of(query, kFinePoints);
  for (Prospect& prospect : prospects) {
    if (auto focused = map.focus(prospect.T_map_body.translation, kFocusM); !focused) {
      return focused;
    }
    prospect.take(refiner.roughly(few, prospect.T_map_body));
  }
  keep_best(kMostFine, prospects);
  for (Prospect& prospect : prospects) {
    if (auto focused = map.focus(prospect.rough.translation, kFocusM); !focused) return focused;
    prospect.take(refiner.finely(more, prospect.rough));
  }
  keep_best(kMostFine, prospects);
  return Done{};
}

Status GlobalSearch::Parts::look_closely(const Sight& sight, const std::vector<Prospect>& prospects,
                                         Refiner& refiner, SearchReport& report) {
  for (const Prospect& prospect : prospects) {
    if (report.candidates.size() == kMostRefined) break;
    if (auto focused = map.focus(prospect.rough.translation, kFocusM); !focused) return focused;
    const Refined refined = refiner.fully(sight, prospect.rough);
    const Vector3d down = refined.T_map_body.rotation.conjugate() * map.info().gravity_map;
    const double tilt = std::acos(std::clamp(down.normalized().dot(sight.gravity_body), -1.0, 1.0));
    if (!refined.usable || !prospect.leads_to(refined.T_map_body) || tilt > kMostTilt) continue;
    const bool copy = std::any_of(
        report.candidates.begin(), report.candidates.end(),
        [&](const Candidate& other) { return same_pose(refined.T_map_body, other.T_map_body); });
    if (copy) continue;
    auto candidate = look_from(map, places, sight, refined);
    if (!candidate) continue;
    candidate->gridded_score = prospect.gridded_score;
    report.candidates.push_back(*candidate);
  }
  return Done{};
}

SearchReport GlobalSearch::find(const SearchQuery& query) {
  SearchReport report;
  std::vector<Prospect> prospects = parts_->search_widely(query, report);
  if (!report.reason.empty()) return report;
  Refiner refiner(parts_->map);
  Status done = parts_->rank(query, refiner, prospects);
  if (done) {
    done = parts_->look_closely(sight_of(query, kFullPoints), prospects, refiner, report);
  }
  report.work += static_cast<std::uint64_t>(kWideWork) * refiner.work();
  if (!done) {
    report.reason = done.error().message;
    return report;
  }
  decide(parts_->config.accept_probability, report);
  return report;
}

}  // namespace holdfast::relocalization
