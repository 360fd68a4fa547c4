#include "holdfast/io/ros/imu_message.hpp"

#include "holdfast/io/bag/bag_records.hpp"

namespace holdfast::io::ros {
namespace {

constexpr std::size_t kQuaternionBytes = 4 * sizeof(double);
constexpr std::size_t kCovarianceValues = 9;
constexpr std::size_t kCovarianceBytes = kCovarianceValues * sizeof(double);

Eigen::Vector3d read_vector(files::ByteReader& reader) {
  const auto x = reader.number<double>();
  const auto y = reader.number<double>();
  const auto z = reader.number<double>();
  return {x, y, z};
}

void append_vector(std::string& out, const Eigen::Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) files::append(out, value);
}

void append_covariance(std::string& out, double first) {
  files::append(out, first);
  for (std::size_t i = 1; i < kCovarianceValues; ++i) files::append(out, 0.0);
}

}  // namespace

std::optional<TimeNs> read_header_stamp(files::ByteReader& reader) {
  reader.number<std::uint32_t>();  // sequence
  const auto seconds = reader.number<std::uint32_t>();
  const auto nanoseconds = reader.number<std::uint32_t>();
  reader.counted();  // frame
  if (!reader.ok() || nanoseconds >= kSecond) return std::nullopt;
  return seconds * kSecond + nanoseconds;
}

void append_header(std::string& out, std::uint32_t sequence, TimeNs stamp, std::string_view frame) {
  files::append(out, sequence);
  bag::append_time(out, stamp);
  files::append_counted(out, frame);
}

std::optional<ImuSample> parse_imu(std::string_view message) {
  files::ByteReader reader(message);
  const auto stamp = read_header_stamp(reader);
  if (!stamp) return std::nullopt;
  ImuSample sample;
  sample.t = *stamp;
  reader.bytes(kQuaternionBytes + kCovarianceBytes);
  sample.gyro_rad_s = read_vector(reader);
  reader.bytes(kCovarianceBytes);
  sample.accel_m_s2 = read_vector(reader);
  reader.bytes(kCovarianceBytes);
  if (!reader.ok() || reader.left() != 0) return std::nullopt;
  return sample;
}

std::string serialise_imu(const ImuSample& sample, std::uint32_t sequence, std::string_view frame) {
  std::string out;
  append_header(out, sequence, sample.t, frame);
  for (const double value : {0.0, 0.0, 0.0, 1.0}) files::append(out, value);
  append_covariance(out, -1.0);
  append_vector(out, sample.gyro_rad_s);
  append_covariance(out, 0.0);
  append_vector(out, sample.accel_m_s2);
  append_covariance(out, 0.0);
  return out;
}

}  // namespace holdfast::io::ros
