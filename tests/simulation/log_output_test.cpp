#include "simulation/log_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/log_file.hpp"
#include "holdfast/io/tum_file.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

namespace fs = std::filesystem;
using testing::event;
using ::testing::HasSubstr;
using testing::make;
using testing::record;

class LogOutput : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("holdfast_simulated_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static SimulationOptions options(int threads) {
    SimulationOptions out;
    out.scenario = "office";
    out.duration_s = 3;
    out.threads = threads;
    out.events = {event("kidnap@2"), event("blind@2.5+0.3"), event("imu_bias_jump@1")};
    return out;
  }

  fs::path write(const char* name, int threads) {
    const auto simulation = make(options(threads));
    double last = 0;
    const auto progress = [&](double share, std::string_view) {
      EXPECT_GE(share, last);
      last = share;
    };
    const Status written = write_log(*simulation, folder_ / name, progress);
    EXPECT_TRUE(written) << (written ? "" : written.error().message);
    EXPECT_EQ(last, 1.0);
    return folder_ / name;
  }

  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

TEST_F(LogOutput, HasTheSameBytesForAnyNumberOfThreads) {
  const fs::path one = write("one", 1);
  const fs::path two = write("two", 2);
  for (const char* name : {"run.bag", "truth.tum", "events.jsonl", "map.pcd", "config.yaml"}) {
    const std::string bytes = content(one / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_TRUE(bytes == content(two / name)) << name;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(one), {}), 5);
}

TEST_F(LogOutput, TheBagHoldsWhatTheSimulationStreams) {
  const fs::path written = write("run", 2);
  const auto log = record(*make(options(2)));
  auto reader = io::open_log(written / "run.bag", {});
  ASSERT_TRUE(reader) << reader.error().message;
  std::size_t imu = 0;
  std::size_t scans = 0;
  while (true) {
    auto next = (*reader)->next();
    ASSERT_TRUE(next) << next.error().message;
    if (!next->has_value()) break;
    if (const auto* sample = std::get_if<ImuSample>(&**next)) {
      ASSERT_EQ(sample->t, log.imu.at(imu).t);
      ASSERT_EQ(sample->gyro_rad_s, log.imu[imu].gyro_rad_s);
      ASSERT_EQ(sample->accel_m_s2, log.imu[imu].accel_m_s2);
      ++imu;
      continue;
    }
    const Scan& read = std::get<Scan>(**next);
    const Scan& truth = log.scans.at(scans);
    ASSERT_EQ(read.stamp, truth.stamp);
    ASSERT_EQ(read.points.size(), truth.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      ASSERT_EQ(read.points[i].x, truth.points[i].x);
      ASSERT_EQ(read.points[i].z, truth.points[i].z);
      ASSERT_EQ(read.points[i].ring, truth.points[i].ring);
      // Point times are float seconds in the bag: half a unit in the last place of 0.1 s is 3.7 ns.
      ASSERT_NEAR(read.points[i].time_offset_ns, truth.points[i].time_offset_ns, 4);
    }
    ++scans;
  }
  EXPECT_EQ(imu, log.imu.size());
  EXPECT_EQ(scans, log.scans.size());
}

TEST_F(LogOutput, TruthAndMapCanBeReadBack) {
  const fs::path written = write("run", 2);
  const auto simulation = make(options(2));
  const auto truth = simulation->truth();
  const auto read = io::read_tum(written / "truth.tum");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_EQ((*read)[i].t, truth[i].t);
    ASSERT_NEAR(((*read)[i].T_map_body.translation - truth[i].T_map_body.translation).norm(), 0,
                1e-9);
  }
  const auto map = io::read_cloud(written / "map.pcd");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->points, simulation->survey_map().points);
}

TEST_F(LogOutput, EventsAreListedInOrderWithAbsoluteTimes) {
  const std::string text = content(write("run", 2) / "events.jsonl");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  const auto jump =
      text.find(R"("t0":1700000001.000000000,"t1":1700000001.000000000,"event":"imu)");
  const auto kidnap = text.find(R"({"t0":1700000002.000000000)");
  const auto blind =
      text.find(R"({"t0":1700000002.500000000,"t1":1700000002.800000000,"event":"blind"})");
  EXPECT_NE(blind, std::string::npos);
  EXPECT_LT(jump, kidnap);
  EXPECT_LT(kidnap, blind);
}

TEST_F(LogOutput, ConfigNamesTheRobotAndWhereItBegins) {
  const fs::path written = write("run", 2);
  const std::string text = content(written / "config.yaml");
  const auto simulation = make(options(2));
  EXPECT_THAT(text, HasSubstr("# initial_pose: " + pose_text(simulation->initial_pose()) + "\n"));
  EXPECT_THAT(text, HasSubstr("\nT_body_lidar: [0.1, 0, 0.15, "));
  EXPECT_THAT(text, HasSubstr("\nimu:\n  gyro_noise_density: 0.0001\n"));
  EXPECT_THAT(text, HasSubstr("\nlidar:\n  range_sigma_m: 0.02\n"));
}

TEST_F(LogOutput, ConfigAndMapHaveTheNoiseAskedFor) {
  SimulationOptions noisy;
  noisy.scenario = "box";
  noisy.duration_s = 1;
  noisy.lidar.range_sigma_m = 0.05;
  noisy.map_sigma_m = 0;
  const auto simulation = make(noisy);
  EXPECT_THAT(robot_config(*simulation), HasSubstr("\nlidar:\n  range_sigma_m: 0.05\n"));
  for (const Eigen::Vector3f& p : simulation->survey_map().points) {
    const Eigen::Vector3f to_wall = p.cwiseMin(Eigen::Vector3f(12, 8, 4) - p).cwiseAbs();
    ASSERT_LT(to_wall.minCoeff(), 1e-5F) << "on a wall";
  }
}

TEST_F(LogOutput, AStrangersFolderIsLeftAlone) {
  std::ofstream(folder_ / "letter.txt") << "dear";
  const auto simulation = make(options(1));
  const Status written = write_log(*simulation, folder_, [](double, std::string_view) {});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr(folder_.string()));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  EXPECT_EQ(content(folder_ / "letter.txt"), "dear");
}

}  // namespace
}  // namespace holdfast::simulation
