#include "holdfast/io/logs/kitti_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/io/files/bytes.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/input_file.hpp"
#include "holdfast/io/files/numbers.hpp"
#include "holdfast/io/logs/kitti_files.hpp"
#include "holdfast/io/logs/log_checks.hpp"

namespace holdfast::io::logs {
namespace {

namespace fs = std::filesystem;
using files::error_at;

/// Columns of an OXTS file: accelerations and rates about the axes of the body.
constexpr std::size_t kAccelX = 11;
constexpr std::size_t kRateX = 17;

/// x, y, z, reflectance, one point after the other; empty for bytes that are not whole points.
std::optional<std::vector<float>> parse_binary_points(const std::string& bytes) {
  if (bytes.size() % (4 * sizeof(float)) != 0) return std::nullopt;
  std::vector<float> values(bytes.size() / sizeof(float));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::optional<std::vector<float>> parse_text_points(const std::string& text) {
  std::vector<float> values;
  std::string_view rest = text;
  std::string_view line;
  while (files::take_line(rest, line)) {
    const auto words = files::split_words(line);
    if (words.empty()) continue;
    if (words.size() != 4) return std::nullopt;
    for (const auto word : words) {
      const auto value = files::parse_double(word);
      if (!value) return std::nullopt;
      values.push_back(static_cast<float>(*value));
    }
  }
  return values;
}

std::optional<std::vector<float>> read_points(const fs::path& path) {
  const auto bytes = files::read_text(path);
  if (!bytes) return std::nullopt;
  return path.extension() == ".bin" ? parse_binary_points(*bytes) : parse_text_points(*bytes);
}

/// Share of the sweep at which the laser points to (x, y): clockwise, 0 and 1 at the rear.
double sweep_share(float x, float y) {
  const double azimuth = std::atan2(static_cast<double>(y), static_cast<double>(x));
  return std::clamp(0.5 - azimuth / (2 * std::numbers::pi), 0.0, 1.0);
}

class KittiLog : public LogReader {
 public:
  explicit KittiLog(LogOptions options) : options_(std::move(options)) {}

  Status prepare(const fs::path& drive);

  Result<std::optional<SensorEvent>> next() override;
  double progress() const override;
  const LogCounters& counters() const override { return counters_; }
  PointTimeLayout point_times() const override { return {"azimuth", "s", false, false}; }
  TimeNs duration() const override;

 private:
  Status list_scans(const fs::path& folder);
  std::optional<ImuSample> read_imu(const TimedFile& file);
  std::optional<Scan> read_scan(std::size_t index);

  LogOptions options_;
  LogCounters counters_;
  std::vector<TimedFile> imu_files_;
  std::vector<TimedFile> scan_files_;  ///< t is the start of the sweep
  std::vector<TimeNs> sweep_ends_;     ///< of scan_files_
  std::size_t next_imu_ = 0;
  std::size_t next_scan_ = 0;
  ImuCheck imu_check_;
  ScanCheck scan_check_;
};

Status KittiLog::prepare(const fs::path& drive) {
  auto slice = check_slice(options_);
  if (!slice) return slice;
  auto scans = list_scans(drive / "velodyne_points");
  if (!scans) return scans;
  std::error_code error;
  if (!options_.need_imu && !fs::exists(drive / "oxts", error)) return Done{};
  auto imu = list_timed_files(drive / "oxts", "timestamps.txt");
  if (!imu) return imu.error();
  imu_files_ = std::move(*imu);
  if (imu_files_.empty() && options_.need_imu) {
    return error_at(drive, "has no IMU: no file with a time in oxts/data");
  }
  return Done{};
}

Status KittiLog::list_scans(const fs::path& folder) {
  auto files = list_timed_files(folder, "timestamps_start.txt");
  if (!files) return files.error();
  scan_files_ = std::move(*files);
  const auto ends = read_timestamps(folder / "timestamps_end.txt");
  if (!ends) return ends.error();
  for (const auto& file : scan_files_) {
    const auto number = static_cast<std::size_t>(file.number);
    const auto end = number < ends->size() ? (*ends)[number] : std::nullopt;
    // A damaged end would stretch the sweep; the turn of a Velodyne takes 0.05 to 0.2 s.
    if (!end || *end <= file.t || *end > file.t + kSecond) {
      return error_at(folder / "timestamps_end.txt",
                      "line {}: expected a time at most 1 s after that in timestamps_start.txt",
                      number + 1);
    }
    sweep_ends_.push_back(*end);
  }
  if (scan_files_.empty()) return error_at(folder, "has no scan: no file with a time in data");
  return Done{};
}

double KittiLog::progress() const {
  const std::size_t all = imu_files_.size() + scan_files_.size();
  return static_cast<double>(next_imu_ + next_scan_) / static_cast<double>(all);
}

TimeNs KittiLog::duration() const {
  TimeNs begin = scan_files_.front().t;
  TimeNs end = sweep_ends_.back();
  if (!imu_files_.empty()) {
    begin = std::min(begin, imu_files_.front().t);
    end = std::max(end, imu_files_.back().t);
  }
  return end - begin;
}

Result<std::optional<SensorEvent>> KittiLog::next() {
  while (next_imu_ < imu_files_.size() || next_scan_ < scan_files_.size()) {
    // A scan is there when its sweep has ended.
    const bool imu_first =
        next_scan_ == scan_files_.size() ||
        (next_imu_ < imu_files_.size() && imu_files_[next_imu_].t <= sweep_ends_[next_scan_]);
    if (imu_first) {
      const auto sample = read_imu(imu_files_[next_imu_++]);
      if (sample) return std::optional<SensorEvent>(*sample);
      continue;
    }
    const std::size_t index = next_scan_++;
    if (!is_in_slice(options_, static_cast<std::int64_t>(index))) continue;
    auto scan = read_scan(index);
    if (scan) return std::optional<SensorEvent>(std::move(*scan));
  }
  return std::optional<SensorEvent>();
}

std::optional<ImuSample> KittiLog::read_imu(const TimedFile& file) {
  const auto oxts = read_oxts(file.path);
  if (!oxts) {
    ++counters_.bad_messages;
    return std::nullopt;
  }
  ImuSample sample;
  sample.t = file.t;
  sample.accel_m_s2 = Eigen::Map<const Eigen::Vector3d>(oxts->data() + kAccelX);
  sample.gyro_rad_s = Eigen::Map<const Eigen::Vector3d>(oxts->data() + kRateX);
  if (!imu_check_.accept(sample, counters_)) return std::nullopt;
  return sample;
}

std::optional<Scan> KittiLog::read_scan(std::size_t index) {
  const auto& file = scan_files_[index];
  const auto values = read_points(file.path);
  if (!values) {
    ++counters_.bad_messages;
    return std::nullopt;
  }
  Scan scan;
  scan.stamp = file.t;
  scan.has_point_times = true;
  const auto sweep = static_cast<double>(sweep_ends_[index] - file.t);
  std::uint32_t no_returns = 0;
  std::int32_t last = 0;
  scan.points.reserve(values->size() / 4);
  for (std::size_t i = 0; i + 3 < values->size(); i += 4) {
    const float* v = values->data() + i;
    if (!(std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]))) {
      ++scan.invalid_points;
      continue;
    }
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) {
      ++no_returns;
      continue;
    }
    const auto offset = static_cast<std::int32_t>(sweep_share(v[0], v[1]) * sweep);
    scan.points.push_back({v[0], v[1], v[2], v[3], offset, 0});
    last = std::max(last, offset);
  }
  scan.end_time = scan.stamp + last;
  const auto number = static_cast<std::int64_t>(index);
  if (!scan_check_.accept(scan, number, no_returns, counters_)) return std::nullopt;
  return scan;
}

}  // namespace

Result<std::unique_ptr<LogReader>> open_kitti_log(const fs::path& path, const LogOptions& options) {
  const auto drive = find_drive(path);
  if (!drive) return drive.error();
  auto log = std::make_unique<KittiLog>(options);
  const auto ready = log->prepare(*drive);
  if (!ready) return ready.error();
  return std::unique_ptr<LogReader>(std::move(log));
}

}  // namespace holdfast::io::logs
