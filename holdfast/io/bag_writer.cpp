#include "holdfast/io/bag_writer.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "holdfast/io/bag/bag_recorder.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/ros/imu_message.hpp"
#include "holdfast/io/ros/message_types.hpp"
#include "holdfast/io/ros/navsat_message.hpp"
#include "holdfast/io/ros/odometry_message.hpp"
#include "holdfast/io/ros/point_cloud2.hpp"

namespace holdfast::io {
namespace {

using files::error_at;

constexpr TimeNs kEndOfTime = (TimeNs{1} << 32) * kSecond;

enum Topic : std::size_t { kImu, kPoints, kWheel, kGnss, kTopics };

/// Where the topics stand among those of the recorder.
using Places = std::array<std::size_t, kTopics>;
constexpr std::size_t kNowhere = kTopics;

/// Topics without a name do not take part.
std::vector<bag::TopicInfo> named_topics(const BagWriter::Topics& topics, Places& places) {
  const std::array<bag::TopicInfo, kTopics> all = {
      {{topics.imu, ros::kImuType, ros::kImuMd5, ros::imu_definition()},
       {topics.points, ros::kPointCloud2Type, ros::kPointCloud2Md5, ros::point_cloud2_definition()},
       {topics.wheel, ros::kOdometryType, ros::kOdometryMd5, ros::odometry_definition()},
       {topics.gnss, ros::kNavSatFixType, ros::kNavSatFixMd5, ros::nav_sat_fix_definition()}}};
  std::vector<bag::TopicInfo> named;
  for (std::size_t i = 0; i < kTopics; ++i) {
    places[i] = all[i].topic.empty() ? kNowhere : named.size();
    if (!all[i].topic.empty()) named.push_back(all[i]);
  }
  return named;
}

/// Empty when no name stands for two topics.
std::string doubled_name(const BagWriter::Topics& topics) {
  const std::array<std::string, kTopics> names = {topics.imu, topics.points, topics.wheel,
                                                  topics.gnss};
  for (std::size_t i = 0; i < kTopics; ++i) {
    if (!names[i].empty() && std::count(names.begin(), names.end(), names[i]) > 1) return names[i];
  }
  return {};
}

class RosbagWriter : public BagWriter {
 public:
  RosbagWriter(std::filesystem::path path, bag::BagRecorder recorder, Places places)
      : path_(std::move(path)), recorder_(std::move(recorder)), places_(places) {}

  Status write(const ImuSample& sample) override {
    return put(kImu, sample.t, sample.t, [&sample](std::uint32_t sequence) {
      return ros::serialise_imu(sample, sequence, "body");
    });
  }

  Status write(const Scan& scan) override { return write(scan, scan.end_time); }

  Status write(const Scan& scan, TimeNs recorded) override {
    return put(kPoints, scan.stamp, recorded, [&scan](std::uint32_t sequence) {
      return ros::serialise_cloud(scan, sequence, "lidar");
    });
  }

  Status write(const WheelSample& sample) override {
    return put(kWheel, sample.t, sample.t, [&sample](std::uint32_t sequence) {
      return ros::serialise_odometry(sample, sequence);
    });
  }

  Status write(const GnssSample& sample) override {
    return put(kGnss, sample.t, sample.t, [&sample](std::uint32_t sequence) {
      return ros::serialise_navsat(sample, sequence);
    });
  }

  Status close() override {
    if (closed_) return error_at(path_, "is already closed");
    closed_ = true;
    return recorder_.close();
  }

 private:
  template <class Serialise>
  Status put(Topic topic, TimeNs stamp, TimeNs recorded, const Serialise& serialise) {
    if (closed_) return error_at(path_, "is closed, nothing can be written to it");
    if (places_[topic] == kNowhere) return error_at(path_, "has no topic for such a message");
    for (const TimeNs t : {stamp, recorded}) {
      if (t >= 0 && t < kEndOfTime) continue;
      return error_at(path_, "time {} cannot be written, a bag holds 0 to 2^32 s",
                      format_seconds(t));
    }
    // ROS tools take a record at time 0 for one without a time.
    return recorder_.write(places_[topic], std::max<TimeNs>(recorded, 1),
                           serialise(sequences_[topic]++));
  }

  std::filesystem::path path_;
  bag::BagRecorder recorder_;
  Places places_;
  std::array<std::uint32_t, kTopics> sequences_{};
  bool closed_ = false;
};

}  // namespace

Result<std::unique_ptr<BagWriter>> BagWriter::create(const std::filesystem::path& path,
                                                     Topics topics, bool compress) {
  if (topics.imu.empty() || topics.points.empty() || topics.imu == topics.points) {
    return error_at(path, "topics '{}' and '{}': expected two different names", topics.points,
                    topics.imu);
  }
  if (const std::string doubled = doubled_name(topics); !doubled.empty()) {
    return error_at(path, "topic '{}' is named twice: expected different names", doubled);
  }
  Places places{};
  auto recorder = bag::BagRecorder::create(path, named_topics(topics, places), compress);
  if (!recorder) return recorder.error();
  return std::unique_ptr<BagWriter>(
      std::make_unique<RosbagWriter>(path, std::move(*recorder), places));
}

}  // namespace holdfast::io
