#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/pipeline/localizer.hpp"
#include "holdfast/pipeline/runner.hpp"
#include "simulation/simulation.hpp"
#include "tests/map/built_map.hpp"

/// Simulated drives localized in the map of their own survey, in process.
namespace holdfast::testing {

/// The value, or the test program ends with the reason.
template <class T>
T valid(Result<T> result) {
  if (result) return std::move(*result);
  ADD_FAILURE() << result.error().message;
  std::abort();
}

/// Events that were recorded before.
class Recording : public SensorSource {
 public:
  explicit Recording(const std::vector<SensorEvent>& events) : events_(events) {}
  Result<std::optional<SensorEvent>> next() override {
    if (at_ == events_.size()) return std::optional<SensorEvent>();
    return std::optional<SensorEvent>(events_[at_++]);
  }
  double progress() const override { return 0; }

 private:
  const std::vector<SensorEvent>& events_;
  std::size_t at_ = 0;
};

/// A source whose events are changed on the way; those for which `alter` is false are left out.
class Altered : public SensorSource {
 public:
  Altered(SensorSource& source, std::function<bool(SensorEvent&)> alter)
      : source_(source), alter_(std::move(alter)) {}
  Result<std::optional<SensorEvent>> next() override {
    while (true) {
      auto event = source_.next();
      if (!event || !event->has_value() || alter_(**event)) return event;
    }
  }
  double progress() const override { return source_.progress(); }

 private:
  SensorSource& source_;
  std::function<bool(SensorEvent&)> alter_;
};

/// The events of a source up to its end.
inline std::vector<SensorEvent> record(SensorSource& source) {
  std::vector<SensorEvent> events;
  while (auto event = valid(source.next())) events.push_back(std::move(*event));
  return events;
}

/// What `holdfast simulate` writes into config.yaml, and the defaults for the rest.
inline pipeline::Config config_of(const simulation::Simulation& simulation) {
  const simulation::SimulationOptions& options = simulation.options();
  pipeline::Config config;
  config.T_body_lidar = options.lidar.T_body_lidar;
  config.has_T_body_lidar = true;
  config.lidar.range_sigma_m = options.lidar.range_sigma_m;
  config.imu.gyro_noise_density = options.imu.gyro_noise_density;
  config.imu.accel_noise_density = options.imu.accel_noise_density;
  config.imu.gyro_bias_walk = options.imu.gyro_bias_walk;
  config.imu.accel_bias_walk = options.imu.accel_bias_walk;
  return config;
}

/// All reports of a localizer on a log.
inline std::vector<StepReport> reports_of(SensorSource& log, const map::testing::BuiltMap& map,
                                          const pipeline::Config& config, const SE3& T_map_body,
                                          int threads = 1) {
  auto localizer =
      valid(pipeline::Localizer::create(config, map.open(), std::optional(T_map_body), threads));
  std::vector<StepReport> reports;
  const auto keep = [&reports](const StepReport& report, double) -> Status {
    reports.push_back(report);
    return Done{};
  };
  valid(pipeline::run(log, localizer, keep));
  return reports;
}

/// A drive and the map of its world's survey.
struct SurveyedDrive {
  explicit SurveyedDrive(const simulation::SimulationOptions& options)
      : simulation(valid(simulation::Simulation::create(options))), map(simulation->survey_map()) {}

  std::string method = pipeline::Config{}.method;
  preprocess::ScanSelectionConfig selection;

  std::vector<StepReport> localize(int threads = 1) { return localize(*simulation, threads); }
  /// `log` is what became of the simulation's events.
  std::vector<StepReport> localize(SensorSource& log, int threads = 1) {
    const SE3 start = simulation->initial_pose();
    pipeline::Config config = config_of(*simulation);
    config.method = method;
    config.preprocess = selection;
    return reports_of(log, map, config, start, threads);
  }

  /// Distance of a report's pose to the truth, m.
  double error_m(const StepReport& report) const {
    return (report.T_map_body.translation - simulation->truth_at(report.pose_time).translation)
        .norm();
  }
  double error_deg(const StepReport& report) const {
    return so3::angle_between(report.T_map_body.rotation,
                              simulation->truth_at(report.pose_time).rotation) *
           180.0 / std::numbers::pi;
  }

  std::unique_ptr<simulation::Simulation> simulation;
  map::testing::BuiltMap map;
};

}  // namespace holdfast::testing
