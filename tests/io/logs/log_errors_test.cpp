#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const bag::TopicInfo kSecondCloud{"/rear/points", ros::kPointCloud2Type, ros::kPointCloud2Md5, ""};
const bag::TopicInfo kSecondImu{"/lidar/imu", ros::kImuType, ros::kImuMd5, ""};
const bag::TopicInfo kCamera{"/camera", "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743",
                             ""};

struct LogErrors : ::testing::Test {
  TemporaryFolder folder;

  std::filesystem::path bag_with(const std::vector<bag::TopicInfo>& further,
                                 const std::vector<std::size_t>& used) {
    BagBytes bag(folder / "log.bag", further);
    const std::string cloud = plain_cloud(kStart, {{1, 2, 3}}).serialised();
    const std::string imu = ros::serialise_imu(imu_at(kStart), 0, "imu");
    for (const std::size_t topic : used) {
      const bool is_cloud =
          topic == 0 || (topic >= 2 && further[topic - 2].type == ros::kPointCloud2Type);
      bag.add(topic, kStart, is_cloud ? cloud : imu);
    }
    return bag.finish();
  }
  std::string error_of_cloud(const CloudBytes& cloud) {
    BagBytes bag(folder / "log.bag");
    bag.add(imu_at(kStart));
    bag.add(cloud);
    return error_of_log(bag.finish());
  }
};

LogOptions options_with(std::string points, std::string imu, bool need_imu = true) {
  LogOptions options;
  options.points_topic = std::move(points);
  options.imu_topic = std::move(imu);
  options.need_imu = need_imu;
  return options;
}

TEST_F(LogErrors, SeveralTopicsOfAKindAreListedWithTheOptionThatChooses) {
  const auto path = bag_with({kSecondCloud, kSecondImu}, {0, 1, 2, 3});
  EXPECT_THAT(error_of_log(path),
              AllOf(HasSubstr("log.bag: has several topics of type sensor_msgs/PointCloud2"),
                    HasSubstr("/points ("), HasSubstr("/rear/points ("),
                    HasSubstr("choose one with --points TOPIC"), Not(HasSubstr("/lidar/imu"))));
  EXPECT_THAT(error_of_log(path, options_with("/points", "")),
              AllOf(HasSubstr("/imu ("), HasSubstr("/lidar/imu ("),
                    HasSubstr("choose one with --imu TOPIC")));
  EXPECT_EQ(read_log(path, options_with("/rear/points", "/lidar/imu")).order.size(), 2U);
}

TEST_F(LogErrors, ATopicWithoutMessagesIsNoCandidate) {
  const auto path = bag_with({kSecondCloud, kSecondImu}, {2, 3});
  EXPECT_EQ(read_log(path).order.size(), 2U);
}

TEST_F(LogErrors, AnUnknownTopicListsTheTopicsThereAre) {
  const auto path = bag_with({kCamera}, {0, 1});
  EXPECT_THAT(error_of_log(path, options_with("/velodyne", "")),
              AllOf(HasSubstr("has no topic '/velodyne' (--points)"),
                    HasSubstr("/camera (sensor_msgs/Image, 0 messages)"),
                    HasSubstr("/imu (sensor_msgs/Imu, 1 messages)"),
                    HasSubstr("/points (sensor_msgs/PointCloud2, 1 messages)")));
  EXPECT_THAT(error_of_log(path, options_with("", "/imu/data")),
              HasSubstr("has no topic '/imu/data' (--imu)"));
}

TEST_F(LogErrors, ATopicOfAnotherTypeIsAnError) {
  const auto path = bag_with({kCamera}, {0, 1});
  EXPECT_THAT(error_of_log(path, options_with("/imu", "")),
              HasSubstr("topic '/imu' (--points) is of type sensor_msgs/Imu, expected "
                        "sensor_msgs/PointCloud2"));
  EXPECT_THAT(error_of_log(path, options_with("", "/camera")),
              HasSubstr("topic '/camera' (--imu) is of type sensor_msgs/Image, expected "
                        "sensor_msgs/Imu"));
}

TEST_F(LogErrors, AnotherVersionOfAMessageIsAnError) {
  const auto path =
      bag_with({{"/old", ros::kImuType, "0123456789abcdef0123456789abcdef", ""}}, {0, 2});
  EXPECT_THAT(error_of_log(path),
              AllOf(HasSubstr("topic '/old' holds another version of sensor_msgs/Imu"),
                    HasSubstr("0123456789abcdef0123456789abcdef"), HasSubstr("6a62c6da")));
}

TEST_F(LogErrors, ALogWithoutImuIsAnErrorUnlessNoneIsNeeded) {
  const auto path = bag_with({}, {0});
  EXPECT_THAT(error_of_log(path),
              AllOf(HasSubstr("topic '/imu' (sensor_msgs/Imu, --imu) holds no messages"),
                    HasSubstr("/points (sensor_msgs/PointCloud2, 1 messages)")));
  EXPECT_EQ(read_log(path, options_with("", "", false)).order, "s");
}

TEST_F(LogErrors, ALogWithoutAScanIsAnError) {
  EXPECT_THAT(error_of_log(bag_with({}, {1})), HasSubstr("topic '/points'"));
}

TEST_F(LogErrors, FieldsOfTypesTheyCannotHaveAreNamed) {
  const auto error_with = [this](std::size_t index, CloudBytes::Field field) {
    auto cloud = plain_cloud(kStart, {{1, 2, 3}, {1, 2, 3}});
    if (index < 3)
      cloud.fields[index] = std::move(field);
    else
      cloud.fields.push_back(std::move(field));
    return error_of_cloud(cloud);
  };
  EXPECT_THAT(error_with(0, {"x", 0, kI16}),
              HasSubstr("log.bag: scan 0: field 'x' is int16, expected one float32 or float64"));
  EXPECT_THAT(error_with(1, {"y", 4, kF32, 3}), HasSubstr("field 'y' is 3 x float32"));
  EXPECT_THAT(error_with(2, {"z", 4, 9}), HasSubstr("field 'z' is type code 9"));
  EXPECT_THAT(error_with(2, {"height", 4}),
              HasSubstr("the points have no field 'z'; their fields are x, y, height"));
  EXPECT_THAT(error_with(2, {"z", 9}),
              HasSubstr("field 'z' at byte 9 lies outside a point of 12 bytes"));
  EXPECT_THAT(error_with(3, {"ring", 0, kU8, 4}),
              HasSubstr("field 'ring' is 4 x uint8, expected one integer"));
  EXPECT_THAT(error_with(3, {"ring", 0, kF32}),
              HasSubstr("field 'ring' is float32, expected one integer"));
  EXPECT_THAT(error_with(3, {"intensity", 0, kU8, 3}),
              HasSubstr("field 'intensity' is 3 x uint8, expected one number"));
  EXPECT_THAT(error_with(3, {"t", 0, kU32, 3}), HasSubstr("field 't' is 3 x uint32"));
  EXPECT_THAT(error_with(0, {"x", 0, kF64}), HasSubstr("field"));
}

TEST_F(LogErrors, MixedTypesOfCoordinatesAreAnError) {
  auto cloud = plain_cloud(kStart, {{1, 2, 3}, {1, 2, 3}});
  cloud.fields = {{"x", 0, kF64}, {"y", 8}, {"z", 12}};
  cloud.point_step = 24;
  cloud.width = 1;
  EXPECT_THAT(error_of_cloud(cloud), HasSubstr("x, y, z are float64, float32, float32"));
}

TEST_F(LogErrors, TimesThatNoUnitExplainsAreAnError) {
  EXPECT_THAT(error_of_cloud(timed_cloud<float>(kStart, "time", kF32, {0, 2.5F})),
              AllOf(HasSubstr("field 'time', float32"), HasSubstr("span 2.5 within a scan"),
                    HasSubstr("0.1 s")));
}

TEST_F(LogErrors, SlicesThatCannotBeAreErrors) {
  const auto path = bag_with({}, {0, 1});
  LogOptions options;
  options.scan_step = 0;
  EXPECT_THAT(error_of_log(path, options), HasSubstr("--scans 0:-1:0"));
  options.scan_step = 1;
  options.scan_start = -2;
  EXPECT_THAT(error_of_log(path, options), HasSubstr("expected START >= 0 and STEP >= 1"));
}

TEST_F(LogErrors, FilesThatAreNoLogsSayWhatWasExpected) {
  EXPECT_THAT(error_of_log(folder / "none.bag"), HasSubstr("none.bag: does not exist"));
  EXPECT_THAT(error_of_log(folder.put("a.mcap", "x")),
              AllOf(HasSubstr("a.mcap: extension '.mcap'"), HasSubstr("ROS 1 bag (.bag)")));
  EXPECT_THAT(error_of_log(folder.put("a.bag", "PK")), HasSubstr("a.bag: is not a ROS 1 bag"));
  EXPECT_THAT(error_of_log(folder.put("b.bag", "")), HasSubstr("b.bag: is not a ROS 1 bag"));
  EXPECT_THAT(
      error_of_log(folder.put("c.bag", "#ROSBAG V1.2\n#")),
      AllOf(HasSubstr("older format '#ROSBAG V1.2'"), HasSubstr("expected '#ROSBAG V2.0'")));
  EXPECT_THAT(error_of_log(folder.put("d.bag", "#ROSBAG V2.0\n")),
              HasSubstr("d.bag: ends early: it has no index and no readable message"));
}

TEST_F(LogErrors, AnEncryptedBagSaysSo) {
  std::string header;
  bag::append_field(header, "op", "\x03");
  bag::append_field(header, "encryptor", "rosbag/AesCbcEncryptor");
  std::string bytes(bag::kMagic);
  files::append_counted(bytes, header);
  files::append_counted(bytes, "");
  EXPECT_THAT(error_of_log(folder.put("a.bag", bytes)),
              HasSubstr("is encrypted (by rosbag/AesCbcEncryptor)"));
}

}  // namespace
}  // namespace holdfast::io::testing
