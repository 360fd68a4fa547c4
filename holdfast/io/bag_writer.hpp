#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "holdfast/core/result.hpp"
#include "holdfast/core/sensor_data.hpp"

namespace holdfast::io {

/// Writes IMU samples and scans as a ROS 1 bag (sensor_msgs/Imu; sensor_msgs/PointCloud2 with
/// x y z intensity float32, ring uint16, time float32 in seconds from header.stamp), and what
/// wheels and satellites tell (nav_msgs/Odometry, sensor_msgs/NavSatFix) if it has topics for them.
/// The file appears under its name only after close(); without close() nothing stays behind. Same
/// input, same bytes. Times before 1970 or after 2106 cannot be written and are errors.
class BagWriter {
 public:
  struct Topics {
    std::string points = "/points";
    std::string imu = "/imu";
    std::string wheel = {};  ///< empty: there is no such topic, and write() of it is an error
    std::string gnss = {};   ///< likewise
  };

  /// `compress`: chunks are packed with LZ4.
  static Result<std::unique_ptr<BagWriter>> create(const std::filesystem::path& path, Topics topics,
                                                   bool compress = false);
  virtual ~BagWriter() = default;

  /// header.stamp and the record time are the sample's time.
  virtual Status write(const ImuSample& sample) = 0;
  /// header.stamp is the time of the first point; the record time is end_time.
  virtual Status write(const Scan& scan) = 0;
  /// Likewise, recorded at another time: that of a computer whose clock is not the LiDAR's.
  virtual Status write(const Scan& scan, TimeNs recorded) = 0;
  /// header.stamp and the record time are the sample's time.
  virtual Status write(const WheelSample& sample) = 0;
  virtual Status write(const GnssSample& sample) = 0;
  virtual Status close() = 0;
};

}  // namespace holdfast::io
