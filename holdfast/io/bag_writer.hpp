#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "holdfast/core/result.hpp"
#include "holdfast/core/sensor_data.hpp"

namespace holdfast::io {

/// Writes IMU samples and scans as a ROS 1 bag (sensor_msgs/Imu; sensor_msgs/PointCloud2 with
/// x y z intensity float32, ring uint16, time float32 in seconds from header.stamp).
/// The file appears under its name only after close(); without close() nothing stays behind. Same
/// input, same bytes. Times before 1970 or after 2106 cannot be written and are errors.
class BagWriter {
 public:
  struct Topics {
    std::string points = "/points";
    std::string imu = "/imu";
  };

  /// `compress`: chunks are packed with LZ4.
  static Result<std::unique_ptr<BagWriter>> create(const std::filesystem::path& path, Topics topics,
                                                   bool compress = false);
  virtual ~BagWriter() = default;

  /// header.stamp and the record time are the sample's time.
  virtual Status write(const ImuSample& sample) = 0;
  /// header.stamp is the time of the first point; the record time is end_time.
  virtual Status write(const Scan& scan) = 0;
  virtual Status close() = 0;
};

}  // namespace holdfast::io
