#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "holdfast/core/step_report.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/monitor/health_monitor.hpp"
#include "holdfast/places/places.hpp"
#include "holdfast/registration/correspondences.hpp"

namespace holdfast::pipeline {

/// What the monitor needs beside the report of a step.
struct SceneView {
  const map::PriorMap& map;
  const registration::BodyPoints& points;  ///< of the scan, in the body frame; empty: no returns
  Eigen::Vector3d p_body_lidar;
  /// What the odometry beside it says, if there is one.
  struct Odometry {
    bool broke = false;
    std::optional<double> way_squared_distance;
  };
  Odometry odometry = {};
};

/// The bridge from a localizer with a map to the monitor: follows some of the scan's rays through
/// the map, asks, and writes the answer into the report of the step.
class MapHealth {
 public:
  /// `places` of the map; none: what is usual is learnt in the run.
  MapHealth(const monitor::MonitorConfig& config, std::shared_ptr<const places::Places> places)
      : config_(config), monitor_(config), places_(std::move(places)) {}

  /// `report` tells the pose, its covariance, the share that agrees, and the state without the
  /// monitor's word. Takes 0.1 to 0.2 ms.
  void judge(const SceneView& scene, StepReport& report);

 private:
  std::optional<monitor::Looks> look(const SceneView& scene, const StepReport& report);
  std::optional<monitor::UsualLooks> usual(const Eigen::Vector3d& p_map_lidar) const;

  monitor::MonitorConfig config_;
  monitor::HealthMonitor monitor_;
  std::shared_ptr<const places::Places> places_;
  std::vector<monitor::SightLine> lines_;
  std::optional<SE3> before_;
};

}  // namespace holdfast::pipeline
