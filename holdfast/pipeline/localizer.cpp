#include "holdfast/pipeline/localizer.hpp"

#include <fmt/format.h>

#include "holdfast/pipeline/graph/graph_localizer.hpp"
#include "holdfast/pipeline/health/dual_index_localizer.hpp"
#include "holdfast/pipeline/methods/feature_selection.hpp"
#include "holdfast/pipeline/methods/map_filter_method.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"
#include "holdfast/pipeline/methods/query_matching.hpp"
#include "holdfast/pipeline/recovery/recovering_localizer.hpp"

namespace holdfast::pipeline {
namespace {

constexpr double kStartRadiusM = 150.0;

features::FeatureConfig feature_config(const Config& config) {
  features::FeatureConfig features = config.feature_extraction;
  if (config.features != "off") features.smoothness = config.features;
  return features;
}

using OptionalPose = std::optional<SE3>;

Result<std::unique_ptr<ScanLocalizer>> make_query_matching(const Config& config, map::PriorMap map,
                                                           const baselines::MapFilter::Setup& start,
                                                           const SE3& T_map_body) {
  if (config.features == "off" || config.method != "map_filter") {
    return Error{fmt::format(
        "fit_at_query: true needs method: map_filter and features: printed, log or fitted; found "
        "method: {} and features: {}",
        config.method, config.features)};
  }
  return QueryMatching::create(std::move(map),
                               {start, feature_config(config), config.query_matching}, T_map_body);
}

Result<GraphLocalizer::Setup> graph_setup(const Config& config, const std::filesystem::path& map,
                                          const baselines::MapFilter::Setup& start) {
  GraphLocalizer::Setup setup;
  setup.start = start;
  setup.smoother = config.estimator;
  setup.smoother.noise.imu = config.imu;
  setup.graph = config.graph;
  setup.odometry = odometry_setup(config, start.threads);
  setup.odometry.odometry.max_points = config.graph.odometry_points;
  if (config.monitor.method == "evidence") {
    auto places = places::Places::open(map);
    if (!places) return places.error();
    setup.monitor = config.monitor;
    setup.places = std::make_shared<const places::Places>(std::move(*places));
  }
  return setup;
}

/// Searching needs the odometry, which carries what was found to now, and places.
bool can_search(const Config& config, const GraphLocalizer::Setup& setup) {
  return config.relocalization.method == "search" && config.graph.odometry == "on" &&
         setup.places && !setup.places->all().empty();
}

Result<std::unique_ptr<ScanLocalizer>> make_graph(const Config& config, map::PriorMap map,
                                                  const baselines::MapFilter::Setup& start,
                                                  const OptionalPose& T_map_body) {
  const std::filesystem::path dir = map.dir();
  const auto setup = graph_setup(config, dir, start);
  if (!setup) return setup.error();
  auto graph = T_map_body ? std::make_unique<GraphLocalizer>(std::move(map), *setup, *T_map_body)
                          : std::make_unique<GraphLocalizer>(std::move(map), *setup);
  if (!can_search(config, *setup)) {
    if (T_map_body) return std::unique_ptr<ScanLocalizer>(std::move(graph));
    return Error{fmt::format(
        "{}: a start without --initial-pose needs a map with places (import it anew if `holdfast "
        "map info` tells of none), relocalization.method: search, graph.odometry: on and "
        "monitor.method: evidence",
        dir.string())};
  }
  auto search = std::async(std::launch::async, [dir, how = config.search] {
    return relocalization::GlobalSearch::create(dir, how);
  });
  return std::unique_ptr<ScanLocalizer>(std::make_unique<RecoveringLocalizer>(
      std::move(graph), std::move(search),
      RecoveringLocalizer::Setup{config.relocalization, config.search.accept_probability,
                                 config.T_body_lidar.translation, config.lidar.range_sigma_m}));
}

Result<std::unique_ptr<ScanLocalizer>> make_matching(const Config& config, map::PriorMap map,
                                                     const baselines::MapFilter::Setup& start,
                                                     const OptionalPose& T_map_body) {
  if (config.method == "graph" && !config.fit_at_query) {
    return make_graph(config, std::move(map), start, T_map_body);
  }
  if (!T_map_body) {
    return Error{fmt::format(
        "no initial pose: give --initial-pose \"x y z qx qy qz qw\" (T_map_body at the end of the "
        "first scan, to within start.position_m and start.rotation_deg); only method: graph starts "
        "without one; found method: {}",
        config.method)};
  }
  if (config.fit_at_query) return make_query_matching(config, std::move(map), start, *T_map_body);
  return std::unique_ptr<ScanLocalizer>(
      std::make_unique<MapFilterMethod>(std::move(map), start, *T_map_body));
}

Result<std::unique_ptr<ScanLocalizer>> make_method(const Config& config, map::PriorMap map,
                                                   int threads, const OptionalPose& T_map_body) {
  auto method = make_matching(config, std::move(map), filter_setup(config, threads), T_map_body);
  if (!method) return method.error();
  if (config.features != "off" && !config.fit_at_query) {
    *method = std::make_unique<FeatureSelection>(std::move(*method), feature_config(config),
                                                 config.lidar.range_sigma_m);
  }
  if (config.monitor.method == "dual_index") {
    *method = std::make_unique<DualIndexLocalizer>(std::move(*method), config.dual_index);
  }
  return method;
}

}  // namespace

Result<Localizer> Localizer::create(const Config& config, map::PriorMap map,
                                    const std::optional<SE3>& T_map_body, int threads) {
  // A damaged tile is found here, not as a robot that is lost.
  if (T_map_body) {
    const auto focused = map.focus(T_map_body->translation, kStartRadiusM);
    if (!focused) return focused.error();
  }
  auto method = make_method(config, std::move(map), threads, T_map_body);
  if (!method) return method.error();
  return Localizer(std::move(*method));
}

void Localizer::add_imu(const ImuSample& sample) { method_->add_imu(sample); }

StepReport Localizer::add_scan(const Scan& scan) { return method_->add_scan(scan); }

}  // namespace holdfast::pipeline
