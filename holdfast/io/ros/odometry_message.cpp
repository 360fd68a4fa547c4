#include "holdfast/io/ros/odometry_message.hpp"

#include <array>
#include <cmath>

#include "holdfast/io/ros/imu_message.hpp"

namespace holdfast::io::ros {
namespace {

constexpr std::size_t kSize = 6;  // x y z and rotations about them
constexpr std::size_t kYawRate = 5;
constexpr double kUnknown = 1e6;

void append_covariance(std::string& out, const std::array<double, kSize>& diagonal) {
  for (std::size_t row = 0; row < kSize; ++row) {
    for (std::size_t column = 0; column < kSize; ++column) {
      files::append(out, row == column ? diagonal[row] : 0.0);
    }
  }
}

std::array<double, kSize> read_diagonal(files::ByteReader& reader) {
  std::array<double, kSize> diagonal{};
  for (std::size_t row = 0; row < kSize; ++row) {
    for (std::size_t column = 0; column < kSize; ++column) {
      const auto value = reader.number<double>();
      if (row == column) diagonal[row] = value;
    }
  }
  return diagonal;
}

template <std::size_t N>
std::array<double, N> read_numbers(files::ByteReader& reader) {
  std::array<double, N> values{};
  for (double& value : values) value = reader.number<double>();
  return values;
}

}  // namespace

std::string serialise_odometry(const WheelSample& sample, std::uint32_t sequence) {
  std::string out;
  append_header(out, sequence, sample.t, "wheel_odom");
  files::append_counted(out, "body");
  const Eigen::Vector3d& p = sample.T_odom_body.translation;
  const Eigen::Quaterniond& q = sample.T_odom_body.rotation;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    files::append(out, value);
  }
  std::array<double, kSize> diagonal{};
  diagonal.fill(kUnknown);
  append_covariance(out, diagonal);
  for (const double value : {sample.speed_m_s, 0.0, 0.0, 0.0, 0.0, sample.yaw_rate_rad_s}) {
    files::append(out, value);
  }
  diagonal[0] = sample.speed_sigma_m_s * sample.speed_sigma_m_s;
  diagonal[kYawRate] = sample.yaw_rate_sigma_rad_s * sample.yaw_rate_sigma_rad_s;
  append_covariance(out, diagonal);
  return out;
}

std::optional<WheelSample> parse_odometry(std::string_view message) {
  files::ByteReader reader(message);
  const auto stamp = read_header_stamp(reader);
  if (!stamp) return std::nullopt;
  reader.counted();  // child frame
  WheelSample sample;
  sample.t = *stamp;
  const auto pose = read_numbers<7>(reader);
  read_diagonal(reader);
  const auto twist = read_numbers<kSize>(reader);
  const auto variances = read_diagonal(reader);
  if (!reader.ok() || reader.left() != 0) return std::nullopt;
  sample.T_odom_body.translation = {pose[0], pose[1], pose[2]};
  sample.T_odom_body.rotation = Eigen::Quaterniond(pose[6], pose[3], pose[4], pose[5]);
  sample.speed_m_s = twist[0];
  sample.yaw_rate_rad_s = twist[kYawRate];
  sample.speed_sigma_m_s = std::sqrt(variances[0]);
  sample.yaw_rate_sigma_rad_s = std::sqrt(variances[kYawRate]);
  return sample;
}

}  // namespace holdfast::io::ros
