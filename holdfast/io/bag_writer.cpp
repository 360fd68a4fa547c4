#include "holdfast/io/bag_writer.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "holdfast/io/bag/bag_recorder.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/ros/imu_message.hpp"
#include "holdfast/io/ros/message_types.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"

namespace holdfast::io {
namespace {

using files::error_at;

constexpr TimeNs kEndOfTime = (TimeNs{1} << 32) * kSecond;

class RosbagWriter : public BagWriter {
 public:
  RosbagWriter(std::filesystem::path path, bag::BagRecorder recorder)
      : path_(std::move(path)), recorder_(std::move(recorder)) {}

  Status write(const ImuSample& sample) override {
    return put(kImu, sample.t, sample.t, [&sample](std::uint32_t sequence) {
      return ros::serialise_imu(sample, sequence, "body");
    });
  }

  Status write(const Scan& scan) override {
    return put(kPoints, scan.stamp, scan.end_time, [&scan](std::uint32_t sequence) {
      return ros::serialise_cloud(scan, sequence, "lidar");
    });
  }

  Status close() override {
    if (closed_) return error_at(path_, "is already closed");
    closed_ = true;
    return recorder_.close();
  }

 private:
  enum Topic : std::size_t { kImu, kPoints };

  template <class Serialise>
  Status put(Topic topic, TimeNs stamp, TimeNs recorded, const Serialise& serialise) {
    if (closed_) return error_at(path_, "is closed, nothing can be written to it");
    for (const TimeNs t : {stamp, recorded}) {
      if (t >= 0 && t < kEndOfTime) continue;
      return error_at(path_, "time {} cannot be written, a bag holds 0 to 2^32 s",
                      format_seconds(t));
    }
    // ROS tools take a record at time 0 for one without a time.
    return recorder_.write(topic, std::max<TimeNs>(recorded, 1), serialise(sequences_[topic]++));
  }

  std::filesystem::path path_;
  bag::BagRecorder recorder_;
  std::array<std::uint32_t, 2> sequences_{};
  bool closed_ = false;
};

}  // namespace

Result<std::unique_ptr<BagWriter>> BagWriter::create(const std::filesystem::path& path,
                                                     Topics topics, bool compress) {
  if (topics.imu.empty() || topics.points.empty() || topics.imu == topics.points) {
    return error_at(path, "topics '{}' and '{}': expected two different names", topics.points,
                    topics.imu);
  }
  auto recorder = bag::BagRecorder::create(
      path,
      {{topics.imu, ros::kImuType, ros::kImuMd5, ros::kImuDefinition},
       {topics.points, ros::kPointCloud2Type, ros::kPointCloud2Md5, ros::kPointCloud2Definition}},
      compress);
  if (!recorder) return recorder.error();
  return std::unique_ptr<BagWriter>(std::make_unique<RosbagWriter>(path, std::move(*recorder)));
}

}  // namespace holdfast::io
