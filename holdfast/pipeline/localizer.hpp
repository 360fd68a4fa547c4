#pragma once

#include <memory>
#include <optional>

#include "holdfast/core/result.hpp"
#include "holdfast/core/step_report.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/pipeline/config.hpp"
#include "holdfast/pipeline/methods/scan_localizer.hpp"

namespace holdfast::pipeline {

/// Where the robot is in a map it already has. Synchronous, with a single owner; not thread-safe.
/// Same calls, same bits, for any number of threads.
class Localizer {
 public:
  /// `T_map_body` is the pose at the first scan's last point, to within Config::start. Without it
  /// the map is searched for it, which only `method: graph` can, with its odometry on and in a map
  /// that has places.
  static Result<Localizer> create(const Config& config, map::PriorMap map,
                                  const std::optional<SE3>& T_map_body, int threads = 1);

  /// Readings in ascending order.
  void add_imu(const ImuSample& sample);

  /// One scan, after the IMU readings up to its last point (EventSequencer sees to that).
  StepReport add_scan(const Scan& scan);

 private:
  explicit Localizer(std::unique_ptr<ScanLocalizer> method) : method_(std::move(method)) {}

  std::unique_ptr<ScanLocalizer> method_;
};

}  // namespace holdfast::pipeline
