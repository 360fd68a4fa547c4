#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "holdfast/core/result.hpp"
#include "holdfast/core/sensor_data.hpp"

namespace holdfast::io {

/// What to take from a log and how to read it.
struct LogOptions {
  std::string points_topic;  ///< empty: the only PointCloud2 topic, else an error that lists them
  std::string imu_topic;     ///< empty: the only Imu topic, else an error that lists them
  /// Scans START:STOP:STEP as in Python slices, counted over the scans of the log; stop < 0: all.
  std::int64_t scan_start = 0;
  std::int64_t scan_stop = -1;
  std::int64_t scan_step = 1;
  bool need_imu = true;  ///< false: a log without IMU is not an error
};

/// What was found wrong in the log and survived. Each counter has a test.
struct LogCounters {
  std::uint64_t imu_samples = 0;
  std::uint64_t scans = 0;
  std::uint64_t points = 0;
  std::uint64_t invalid_points = 0;  ///< NaN or infinite coordinates, or a time far off its scan
  std::uint64_t no_return_points =
      0;  ///< points at (0, 0, 0): what drivers write for "nothing seen"
  std::uint64_t empty_scans = 0;
  std::uint64_t non_finite_imu = 0;   ///< samples dropped
  std::uint64_t imu_stamps_back = 0;  ///< samples dropped, older than or equal to their predecessor
  std::uint64_t scan_stamps_back = 0;  ///< scans dropped, older than or equal to their predecessor
  std::uint64_t imu_stamps_ahead =
      0;  ///< samples dropped, a lone stamp more than 10 s in the future
  std::uint64_t scan_stamps_ahead = 0;  ///< scans dropped, likewise
  std::uint64_t bad_messages = 0;       ///< messages whose layout does not hold together, dropped
  bool truncated = false;  ///< the file ended early or has no index; what is there was used
};

/// How the times of the points were understood.
struct PointTimeLayout {
  std::string field;      ///< "time", "t", "timestamp", ...; empty: none
  std::string unit;       ///< "s", "ms", "us", "ns"; empty: none
  bool absolute = false;  ///< absolute stamps instead of offsets from header.stamp
  bool own_clock =
      false;  ///< neither: a clock of the sensor's own, its first point is at header.stamp
};

/// A log on disk as a stream of sensor events in recorded order. Only scans are sliced, IMU samples
/// are all delivered.
class LogReader : public SensorSource {
 public:
  virtual const LogCounters& counters() const = 0;
  /// Known after the first scan.
  virtual PointTimeLayout point_times() const = 0;
  /// Times of the first and last message in the log, as far as the index tells.
  virtual TimeNs duration() const = 0;
};

/// Opens a log by what it is: a ROS 1 bag (.bag) or a KITTI raw drive (a folder that holds
/// velodyne_points/ and oxts/, or one such folder below it).
Result<std::unique_ptr<LogReader>> open_log(const std::filesystem::path& path,
                                            const LogOptions& options);

}  // namespace holdfast::io
