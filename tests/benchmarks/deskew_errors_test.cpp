#include "benchmarks/scores/deskew_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/bench.hpp"

namespace holdfast::benchmarks {
namespace {

using preprocess::EndState;

/// A drive in the empty box with a perfect IMU, and the IMU readings up to the end of its last
/// scan.
struct Drive {
  std::unique_ptr<simulation::Simulation> simulation;
  Scan last;
  preprocess::ImuSegment imu;

  explicit Drive(double duration_s, double range_sigma_m = 0) {
    simulation::SimulationOptions options;
    options.scenario = "box";
    options.duration_s = duration_s;
    options.imu = simulation::ImuModel::perfect();
    options.lidar.range_sigma_m = range_sigma_m;
    simulation = std::move(*simulation::Simulation::create(options));
    preprocess::ImuBuffer buffer;
    for (auto event = simulation->next(); event && event->has_value(); event = simulation->next()) {
      if (const auto* sample = std::get_if<ImuSample>(&**event)) buffer.add(*sample);
      if (const auto* scan = std::get_if<Scan>(&**event)) last = *scan;
    }
    EXPECT_TRUE(buffer.segment(last.stamp, last.end_time, imu));
  }
  PlacementErrors errors(const EndState& estimated) {
    return placement_errors(last, *simulation, imu, estimated);
  }
  EndState truth() const { return true_end_state(*simulation, last.end_time); }
};

double exact(const PlacementErrors& errors, Placement placement) {
  return errors[static_cast<std::size_t>(placement)].off_surface_exact_m;
}
double noisy(const PlacementErrors& errors, Placement placement) {
  return errors[static_cast<std::size_t>(placement)].off_surface_m;
}

TEST(DeskewErrors, AtRestAllPlacementsAgree) {
  Drive drive(1.5);
  const auto errors = drive.errors(drive.truth());
  for (const PlacementError& e : errors) EXPECT_LT(e.off_surface_m, 1e-5);
}

TEST(DeskewErrors, InMotionTrueStateAndTruePosesLeaveNothingAndRawPointsLieOff) {
  Drive drive(6);
  ASSERT_GT(drive.truth().v_end.norm(), 0.8) << "it drives";
  const auto errors = drive.errors(drive.truth());
  EXPECT_LT(exact(errors, Placement::kTruePoses), 1e-5);
  // Knots to first order: below 0.2 mm (see ScanMotion); midpoint rule at 200 Hz less than that.
  EXPECT_LT(exact(errors, Placement::kTrueState), 2e-4);
  EXPECT_EQ(exact(errors, Placement::kTrueState), exact(errors, Placement::kDeskewed));
  EXPECT_GT(exact(errors, Placement::kRaw), 5e-3);
  EXPECT_GT(errors[0].across_edge_m, 5e-3);
  EXPECT_LT(errors[3].across_edge_m, 1e-5);
}

// A velocity that is wrong by 0.5 m/s straight up displaces a point by that times its age.
TEST(DeskewErrors, AWrongVelocityDisplacesAsManyMetresASecond) {
  Drive drive(1.5);
  EndState estimated = drive.truth();
  estimated.v_end += Eigen::Vector3d(0, 0, 0.5);
  const auto errors = drive.errors(estimated);
  const auto truth = drive.simulation->true_geometry(drive.last);
  double sum = 0;
  double n = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].edge_distance_m < kClearOfEdgesM) continue;
    const TimeNs t = drive.last.stamp + drive.last.points[i].time_offset_ns;
    sum += 0.5 * to_seconds(drive.last.end_time - t) * std::abs(truth[i].normal_map.z());
    ++n;
  }
  EXPECT_GT(sum / n, 1e-3);
  EXPECT_NEAR(exact(errors, Placement::kDeskewed), sum / n, 1e-5);
  EXPECT_LT(exact(errors, Placement::kTrueState), 1e-5);
}

TEST(DeskewErrors, RangeNoiseIsInTheNoisyFigureOnly) {
  Drive drive(1.5, 0.02);
  const auto errors = drive.errors(drive.truth());
  // Mean |normal| is sqrt(2 / pi) sigma, times the mean cosine of incidence, which is below 1.
  EXPECT_GT(noisy(errors, Placement::kTruePoses), 0.006);
  EXPECT_LT(noisy(errors, Placement::kTruePoses), 0.02 * std::sqrt(2 / M_PI));
  EXPECT_LT(exact(errors, Placement::kTruePoses), 1e-5);
}

TEST(DeskewBench, KeepsItsKeysAndStaysWithinFivePerCentOfTheTruePoses) {
  BenchOptions options;
  options.duration_s = 12;
  const auto report = run_bench(**find_bench("deskew"), options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->data["results"].size(), 4U);
  for (const auto& result : report->data["results"]) {
    ASSERT_TRUE(result.contains("scans"));
    if (result["scans"] == 0) continue;
    EXPECT_LE(result["deskewed_to_true_poses"].get<double>(), 1.05) << result.dump();
    EXPECT_LE(result["deskewed"]["off_surface_exact"]["mean_m"].get<double>(), 0.001);
    EXPECT_GT(result["raw"]["off_surface"]["mean_m"].get<double>(),
              result["deskewed"]["off_surface"]["mean_m"].get<double>());
  }
  ASSERT_EQ(report->data["accuracy"].size(), 2U);
  EXPECT_TRUE(report->data["accuracy"][0].contains("deskewed_median_m"));
}

}  // namespace
}  // namespace holdfast::benchmarks
