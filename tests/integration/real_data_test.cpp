#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "evaluation/truth_track.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/kitti_raw.hpp"
#include "holdfast/io/log_file.hpp"
#include "holdfast/io/tum_file.hpp"
#include "holdfast/pipeline/accumulate.hpp"
#include "tests/integration/drive_in_map.hpp"

/// Public recordings and maps, where they are installed.
namespace holdfast::testing {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  if (const char* folder = std::getenv("HOLDFAST_DATA")) return folder;
  const auto repository = fs::path(__FILE__).parent_path().parent_path().parent_path();
  return repository.parent_path() / "shared" / "data";
}

Scan first_scan(SensorSource& log) {
  while (auto event = valid(log.next())) {
    if (auto* scan = std::get_if<Scan>(&*event)) return std::move(*scan);
  }
  ADD_FAILURE() << "no scan";
  return {};
}

struct RealData : ::testing::Test {
  fs::path data = data_folder();

  void SetUp() override {
    if (!fs::exists(data / "kitti_0009")) GTEST_SKIP() << "no recordings in " << data;
  }
};

/// A drive through a street at 11 m/s: each second scan makes the map, the others are localized.
struct Kitti9 : RealData {
  std::vector<StampedPose> truth;
  pipeline::Config config;

  void SetUp() override {
    RealData::SetUp();
    if (IsSkipped()) return;
    truth = valid(io::read_tum(data / "kitti_0009/truth.tum"));
    config.T_body_lidar = extrinsic();
    config.has_T_body_lidar = true;
  }

  SE3 extrinsic() const {
    std::ifstream file(data / "kitti_0009/extrinsics.txt");
    std::string comment;
    std::getline(file, comment);
    SE3 T;
    auto& q = T.rotation;
    auto& p = T.translation;
    file >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
    EXPECT_TRUE(file) << "extrinsics.txt";
    q.normalize();
    return T;
  }

  /// Scans first, first + 2, ... of the drive.
  std::unique_ptr<io::LogReader> every_second(int first) const {
    io::LogOptions options;
    options.scan_start = first;
    options.scan_step = 2;
    return valid(io::open_log(data / "kitti_0009/run.bag", options));
  }

  io::PointCloud cloud_of_the_others() const {
    io::PointCloud cloud;
    preprocess::ScanSelectionConfig selection;
    selection.min_range_m = 2.5;  // without the car itself
    const auto log = every_second(1);
    const auto added =
        valid(pipeline::accumulate(*log, truth, config.T_body_lidar, selection, cloud));
    EXPECT_EQ(added.scans + added.outside, 25U);
    EXPECT_GE(added.scans, 24U);
    return cloud;
  }

  SE3 truth_at(TimeNs t) const {
    const auto sample = evaluation::TruthTrack(truth).at(t);
    EXPECT_TRUE(sample.known());
    return sample.T_map_body;
  }
};

TEST_F(Kitti9, OddScansAreLocalizedInTheMapOfTheEvenOnes) {
  const map::testing::BuiltMap map(cloud_of_the_others());
  const auto log = every_second(0);
  const SE3 start = truth_at(first_scan(*every_second(0)).end_time);
  const auto reports = reports_of(*log, map, config, start);
  ASSERT_EQ(reports.size(), 26U);
  double squares = 0;
  double most = 0;
  int claims = 0;
  TimeNs first_claim = 0;
  for (const StepReport& r : reports) {
    if (!claims_pose(r.state)) continue;
    if (claims++ == 0) first_claim = r.pose_time;
    const auto sample = evaluation::TruthTrack(truth).at(r.pose_time);
    if (!sample.known()) continue;
    const double error = (r.T_map_body.translation - sample.T_map_body.translation).norm();
    squares += error * error;
    most = std::max(most, error);
  }
  ASSERT_GT(claims, 0);
  EXPECT_LE(to_seconds(first_claim - reports.front().pose_time), 0.5);
  EXPECT_GE(claims, 22);
  const double rmse = std::sqrt(squares / claims);
  EXPECT_LE(rmse, 0.10);
  EXPECT_LE(most, 0.30);
  std::printf("kitti_0009: %d claims, RMSE %.3f m, max %.3f m\n", claims, rmse, most);
}

TEST_F(RealData, AMapIsMadeOfKittiTwoAndItsOwnScansAreFoundInIt) {
  const fs::path drive = data / "kitti_0002";
  const auto truth = valid(io::read_kitti_truth(drive));
  pipeline::Config config;
  config.T_body_lidar = valid(io::read_kitti_extrinsics(drive));
  config.has_T_body_lidar = true;
  ASSERT_EQ(truth.size(), 10U);
  io::PointCloud cloud;
  preprocess::ScanSelectionConfig selection;
  selection.min_range_m = 2.5;
  const auto log = valid(io::open_log(drive, {}));
  const auto added =
      valid(pipeline::accumulate(*log, truth, config.T_body_lidar, selection, cloud));
  EXPECT_EQ(added.scans + added.outside, 10U);
  EXPECT_GE(added.scans, 8U);  // the first and the last sweep reach beyond the poses
  const map::testing::BuiltMap map(std::move(cloud));
  EXPECT_GT(map.info().levels[0].planes, 1000U);

  evaluation::TruthTrack track(truth, 0.2);
  std::optional<SE3> start;
  const auto peek = valid(io::open_log(drive, {}));
  while (const auto event = valid(peek->next())) {
    if (!std::holds_alternative<Scan>(*event)) continue;
    const auto sample = track.at(std::get<Scan>(*event).end_time);
    if (sample.known()) {
      start = sample.T_map_body;
      break;
    }
  }
  ASSERT_TRUE(start);
  const auto again = valid(io::open_log(drive, {}));
  const auto reports = reports_of(*again, map, config, *start);
  EXPECT_EQ(reports.size(), 10U);
  EXPECT_TRUE(claims_pose(reports.back().state)) << reports.back().reason;
}

struct RealMap : RealData, ::testing::WithParamInterface<const char*> {};

TEST_P(RealMap, IsImportedVerifiedAndExportedPointForPoint) {
  const auto cloud = valid(io::read_cloud(data / GetParam()));
  const map::testing::BuiltMap built(cloud, 2);
  const auto verified = map::PriorMap::verify(built.path(), built.info());
  EXPECT_TRUE(verified) << verified.error().message;
  EXPECT_GT(built.info().levels[0].planes, 100U);
  const auto exported = valid(map::PriorMap::read_points(built.path(), built.info()));
  EXPECT_EQ(exported.points.size(), cloud.points.size());
  const auto sum = [](const io::PointCloud& c) {
    Eigen::Vector3d s = Eigen::Vector3d::Zero();
    for (const auto& p : c.points) s += p.cast<double>() + c.origin;
    return s;
  };
  // Sums of millions of numbers of up to 1000 m, in another order.
  EXPECT_LT((sum(exported) - sum(cloud)).norm() / static_cast<double>(cloud.points.size()), 1e-6);
  auto map = built.open();
  ASSERT_TRUE(map.focus(0.5 * (built.info().bounds_min + built.info().bounds_max), 50.0));
  EXPECT_GT(map.loaded_tiles(), 0U);
}

INSTANTIATE_TEST_SUITE_P(OfTheSharedData, RealMap,
                         ::testing::Values("utd_campus_west/map.pcd", "small_maps/hdl_indoor.pcd",
                                           "small_maps/surf.pcd", "small_maps/corner.pcd"),
                         [](const auto& name) {
                           std::string text = name.param;
                           for (char& c : text) c = std::isalnum(c) != 0 ? c : '_';
                           return text;
                         });

TEST_F(RealData, FeatureCloudsBecomeAMapOfPlanesAndLines) {
  map::MapSource source;
  source.cloud = valid(io::read_cloud(data / "small_maps/surf.pcd"));
  source.edges = valid(io::read_cloud(data / "small_maps/corner.pcd"));
  source.name = "features";
  const std::size_t points = source.cloud.points.size() + source.edges->points.size();
  const map::testing::BuiltMap built(std::move(source), 2);
  EXPECT_EQ(built.info().points, points);
  EXPECT_GT(built.info().levels[0].planes, 100U);
  // Lines stand where no plane does.
  EXPECT_GT(built.info().levels[0].lines, 10U);
}

}  // namespace
}  // namespace holdfast::testing
