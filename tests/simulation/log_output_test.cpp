#include "simulation/log_output.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "holdfast/io/bag/bag_file.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/log_file.hpp"
#include "holdfast/io/ros/navsat_message.hpp"
#include "holdfast/io/ros/odometry_message.hpp"
#include "holdfast/io/tum_file.hpp"
#include "simulation/stated_extrinsics.hpp"
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

TEST_F(LogOutput, WheelsAndSatellitesHaveTopicsOfTheirOwnInOrderOfTime) {
  SimulationOptions asked = options(2);
  asked.wheel.emplace();
  asked.gnss.emplace();
  asked.gnss->outages_per_minute = 30;
  asked.transport.imu_samples = {0.3, 5};  // gaps, over which the others are still in order
  const auto simulation = make(asked);
  ASSERT_TRUE(write_log(*simulation, folder_ / "run", [](double, std::string_view) {}));
  const auto wheel = simulation->wheel_samples();
  const auto gnss = simulation->gnss_samples();
  ASSERT_EQ(wheel.size(), 150U);
  ASSERT_EQ(gnss.size(), 31U);
  auto bag = io::bag::BagFile::open(folder_ / "run" / "run.bag");
  ASSERT_TRUE(bag) << bag.error().message;
  std::uint64_t lost = 0;
  std::size_t wheels = 0;
  std::size_t fixes = 0;
  std::pair<std::uint32_t, std::uint32_t> last_place;
  for (const auto& place : bag->list_messages({true, true, true, true}, lost)) {
    const auto in_file = std::pair(place.chunk, place.offset);
    EXPECT_GE(in_file, last_place) << "written in the order of time";
    last_place = in_file;
    const std::string& topic = bag->connections()[place.connection].topic;
    const auto message = bag->read(place);
    ASSERT_TRUE(message);
    if (topic == "/wheel_odometry") {
      const auto sample = io::ros::parse_odometry(*message);
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->t, wheel[wheels].t);
      EXPECT_EQ(sample->speed_m_s, wheel[wheels].speed_m_s);
      EXPECT_EQ(sample->yaw_rate_rad_s, wheel[wheels].yaw_rate_rad_s);
      EXPECT_EQ(sample->T_odom_body.translation, wheel[wheels].T_odom_body.translation);
      EXPECT_NEAR(sample->speed_sigma_m_s, wheel[wheels].speed_sigma_m_s, 1e-15);
      ++wheels;
    } else if (topic == "/gnss") {
      const auto sample = io::ros::parse_navsat(*message);
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->t, gnss[fixes].t);
      EXPECT_EQ(sample->has_fix, gnss[fixes].has_fix);
      EXPECT_EQ(std::isnan(sample->latitude_deg), !sample->has_fix);
      EXPECT_TRUE(!sample->has_fix || sample->longitude_deg == gnss[fixes].longitude_deg);
      ++fixes;
    }
  }
  EXPECT_EQ(lost, 0U);
  EXPECT_EQ(wheels, wheel.size());
  EXPECT_EQ(fixes, gnss.size());
  EXPECT_TRUE(io::open_log(folder_ / "run" / "run.bag", {})) << "one cloud and one IMU topic";
  EXPECT_THAT(content(folder_ / "run" / "config.yaml"), HasSubstr("# gnss: map origin at"));
}

TEST_F(LogOutput, RecordsScansAtTheirTrueTimeWhateverTheLidarsClockSays) {
  SimulationOptions asked = options(2);
  asked.transport.lidar_clock.offset_sigma_s = 3;
  const auto right = make(options(2));
  const auto wrong = make(asked);
  ASSERT_TRUE(write_log(*right, folder_ / "right", [](double, std::string_view) {}));
  ASSERT_TRUE(write_log(*wrong, folder_ / "wrong", [](double, std::string_view) {}));
  const auto places = [&](const char* name) {
    auto bag = io::bag::BagFile::open(folder_ / name / "run.bag");
    std::uint64_t lost = 0;
    return bag->list_messages({true, true}, lost);
  };
  const auto of_right = places("right");
  const auto of_wrong = places("wrong");
  ASSERT_EQ(of_right.size(), of_wrong.size());
  for (std::size_t i = 0; i < of_right.size(); ++i) ASSERT_EQ(of_right[i].time, of_wrong[i].time);
  EXPECT_THAT(
      content(folder_ / "wrong" / "config.yaml"),
      HasSubstr(fmt::format("# lidar_clock: ahead by {:.9f} s", wrong->lidar_clock().offset_s())));
  EXPECT_EQ(content(folder_ / "right" / "truth.tum"), content(folder_ / "wrong" / "truth.tum"));
}

TEST_F(LogOutput, ConfigMayStateAnExtrinsicThatIsOff) {
  SimulationOptions asked = options(1);
  asked.extrinsics_error = {0.01, 0.005};
  const auto simulation = make(asked);
  const std::string text = robot_config(*simulation);
  EXPECT_THAT(text, HasSubstr("\n# true_T_body_lidar: [0.1, 0, 0.15, "));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("\nT_body_lidar: [0.1, 0, 0.15, ")));
  const SE3& truth = asked.lidar.T_body_lidar;
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const SE3 off = truth.inverse() * stated_extrinsics(truth, asked.extrinsics_error, seed);
    EXPECT_NEAR(off.translation.norm(), 0.01, 1e-15);
    EXPECT_NEAR(so3::log(off.rotation).norm(), 0.005, 1e-15);
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
