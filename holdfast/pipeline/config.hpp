#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "baselines/map_filter.hpp"
#include "holdfast/estimator/smoother_options.hpp"
#include "holdfast/features/feature_config.hpp"
#include "holdfast/io/config_io.hpp"
#include "holdfast/monitor/dual_index.hpp"
#include "holdfast/monitor/monitor_config.hpp"
#include "holdfast/odometry/odometry_config.hpp"
#include "holdfast/pipeline/graph/graph_localizer.hpp"
#include "holdfast/pipeline/recovery/relocalization_config.hpp"
#include "holdfast/preprocess/scan_selection.hpp"
#include "holdfast/registration/fit_at_query.hpp"
#include "holdfast/relocalization/search_config.hpp"

namespace holdfast::pipeline {

struct LidarConfig {
  double range_sigma_m = 0.02;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_sigma_m", self.range_sigma_m,
          FieldDoc{"standard deviation of a range, along the ray (article, section 1)", 1e-4, 1.0});
  }
};

/// How far off a given initial pose may be.
struct StartConfig {
  double position_m = 1.0;
  double rotation_deg = 10.0;
  double speed_m_s = 15.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_m", self.position_m,
          FieldDoc{"error to be expected of the initial position", 0.01, 5.0});
    visit("rotation_deg", self.rotation_deg,
          FieldDoc{"error to be expected of the initial rotation", 0.1, 30.0});
    visit("speed_m_s", self.speed_m_s,
          FieldDoc{"speed that the robot may already have at the start", 0.0, 100.0});
  }
};

/// The whole configuration. Every key has a default but the extrinsic calibration, which nobody can
/// guess.
struct Config {
  SE3 T_body_lidar;
  bool has_T_body_lidar = false;
  std::string method = "graph";
  std::string features = "off";
  bool fit_at_query = false;
  LidarConfig lidar;
  filter::ImuNoiseConfig imu;
  StartConfig start;
  preprocess::ScanSelectionConfig preprocess;
  features::FeatureConfig feature_extraction;
  registration::FitAtQueryConfig query_matching;
  baselines::MapFilterConfig map_filter;
  estimator::SmootherConfig estimator;
  GraphConfig graph;
  odometry::OdometryConfig odometry;
  odometry::LocalMapConfig local_map;
  monitor::MonitorConfig monitor;
  monitor::DualIndexConfig dual_index;
  RelocalizationConfig relocalization;
  relocalization::SearchConfig search;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "T_body_lidar", self.T_body_lidar,
        FieldDoc{"pose of the LiDAR in the body frame (the IMU's): x, y, z in m, then qx, qy, qz, "
                 "qw; required"},
        &self.has_T_body_lidar);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    visit("method", self.method, FieldDoc{"localizer", -kAny, kAny, "graph|map_filter"});
    visit("features", self.features,
          FieldDoc{"points of a scan that are matched (article 3.2.1): all, spread over the scan "
                   "(off); or its edges and planes only, by the article's smoothness (printed), "
                   "its logarithm (log), or straight windows of a metric length (fitted)",
                   -kAny, kAny, "off|printed|log|fitted"});
    visit("fit_at_query", self.fit_at_query,
          FieldDoc{"fit lines and planes of the map at query time (article 3.2.2) instead of once "
                   "when the map is made; slow, and needs method: map_filter and features"});
  }
};

/// All fields of `config`, by their keys. The references point into `config`.
std::vector<io::FieldRef> fields_of(Config& config);

/// Defaults, then the file (unless the path is empty), then each `key=value`. Errors name file and
/// key; a missing extrinsic names T_body_lidar.
Result<Config> load_config(const std::filesystem::path& file,
                           const std::vector<std::string>& assignments);

}  // namespace holdfast::pipeline
