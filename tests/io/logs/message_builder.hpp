#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/io/bag/bag_recorder.hpp"
#include "holdfast/io/bag/bag_records.hpp"
#include "holdfast/io/files/bytes.hpp"
#include "holdfast/io/ros/imu_message.hpp"
#include "holdfast/io/ros/message_types.hpp"

/// Messages and bags of any content, good or bad, for the tests of the reader.
namespace holdfast::io::testing {

inline constexpr TimeNs kStart = 1'700'000'000 * kSecond;
inline constexpr TimeNs kPeriod = kSecond / 10;

/// Codes of sensor_msgs/PointField.
enum Code : std::uint8_t { kI8 = 1, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

/// A sensor_msgs/PointCloud2, member by member.
struct CloudBytes {
  struct Field {
    std::string name;
    std::uint32_t offset = 0;
    std::uint8_t code = kF32;
    std::uint32_t count = 1;
  };
  TimeNs stamp = kStart;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<Field> fields = {{"x", 0}, {"y", 4}, {"z", 8}};
  bool big_endian = false;
  std::uint32_t point_step = 12;
  std::uint32_t row_step = 0;
  std::string data;

  std::string serialised() const {
    std::string out;
    ros::append_header(out, 7, stamp, "lidar");
    files::append(out, height);
    files::append(out, width);
    files::append(out, static_cast<std::uint32_t>(fields.size()));
    for (const auto& field : fields) {
      files::append_counted(out, field.name);
      files::append(out, field.offset);
      files::append(out, field.code);
      files::append(out, field.count);
    }
    files::append(out, static_cast<std::uint8_t>(big_endian));
    files::append(out, point_step);
    files::append(out, row_step);
    files::append_counted(out, data);
    files::append(out, std::uint8_t{1});
    return out;
  }
};

/// A cloud of points (i + 1, 2, 3), i = 0 ..., each followed by times[i] as a field of type T.
template <class T>
CloudBytes timed_cloud(TimeNs stamp, const std::string& field, Code code,
                       const std::vector<T>& times, std::uint32_t count = 1) {
  CloudBytes cloud;
  cloud.stamp = stamp;
  cloud.width = static_cast<std::uint32_t>(times.size());
  cloud.fields.push_back({field, 12, code, count});
  cloud.point_step = static_cast<std::uint32_t>(12 + sizeof(T));
  cloud.row_step = cloud.point_step * cloud.width;
  for (std::size_t i = 0; i < times.size(); ++i) {
    for (const float v : {static_cast<float>(i + 1), 2.0F, 3.0F}) files::append(cloud.data, v);
    files::append(cloud.data, times[i]);
  }
  return cloud;
}

/// A cloud of the given coordinates without times.
inline CloudBytes plain_cloud(TimeNs stamp, const std::vector<Eigen::Vector3f>& points) {
  CloudBytes cloud;
  cloud.stamp = stamp;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.row_step = 12 * cloud.width;
  for (const auto& p : points) {
    for (int axis = 0; axis < 3; ++axis) files::append(cloud.data, p[axis]);
  }
  return cloud;
}

inline ImuSample imu_at(TimeNs t) { return {t, {0.01, -0.02, 0.03}, {0.1, 0.2, 9.8}}; }

/// A bag with a topic of clouds, /points, and one of IMU samples, /imu.
class BagBytes {
 public:
  explicit BagBytes(std::filesystem::path path, std::vector<bag::TopicInfo> further = {})
      : path_(std::move(path)) {
    std::vector<bag::TopicInfo> topics = {
        {"/points", ros::kPointCloud2Type, ros::kPointCloud2Md5, ros::point_cloud2_definition()},
        {"/imu", ros::kImuType, ros::kImuMd5, ros::imu_definition()}};
    for (auto& topic : further) topics.push_back(std::move(topic));
    auto recorder = bag::BagRecorder::create(path_, std::move(topics), false);
    EXPECT_TRUE(recorder) << recorder.error().message;
    recorder_ = std::make_unique<bag::BagRecorder>(std::move(*recorder));
  }

  /// Appends a message of a topic (0: /points, 1: /imu, 2: the first further one).
  void add(std::size_t topic, TimeNs recorded, std::string_view message) {
    EXPECT_TRUE(recorder_->write(topic, recorded, message));
  }
  void add(const CloudBytes& cloud) { add(0, cloud.stamp + kPeriod, cloud.serialised()); }
  void add(const ImuSample& sample) { add(1, sample.t, ros::serialise_imu(sample, 0, "imu")); }

  std::filesystem::path finish() {
    EXPECT_TRUE(recorder_->close());
    return path_;
  }

 private:
  std::filesystem::path path_;
  std::unique_ptr<bag::BagRecorder> recorder_;
};

}  // namespace holdfast::io::testing
