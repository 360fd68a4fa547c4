#include "holdfast/io/ros/navsat_message.hpp"

#include <cmath>
#include <limits>

#include "holdfast/io/ros/imu_message.hpp"

namespace holdfast::io::ros {
namespace {

constexpr std::int8_t kNoFix = -1;
constexpr std::int8_t kGroundAugmented = 2;
constexpr std::uint16_t kGps = 1;
constexpr std::uint8_t kCovarianceUnknown = 0;
constexpr std::uint8_t kDiagonalKnown = 2;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::string serialise_navsat(const GnssSample& sample, std::uint32_t sequence) {
  std::string out;
  append_header(out, sequence, sample.t, "gnss");
  files::append(out, sample.has_fix ? kGroundAugmented : kNoFix);
  files::append(out, kGps);
  for (const double value : {sample.latitude_deg, sample.longitude_deg, sample.altitude_m}) {
    files::append(out, sample.has_fix ? value : kNone);
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double sigma = sample.has_fix && row == column ? sample.sigma_enu_m[row] : 0.0;
      files::append(out, sigma * sigma);
    }
  }
  files::append(out, sample.has_fix ? kDiagonalKnown : kCovarianceUnknown);
  return out;
}

std::optional<GnssSample> parse_navsat(std::string_view message) {
  files::ByteReader reader(message);
  const auto stamp = read_header_stamp(reader);
  if (!stamp) return std::nullopt;
  GnssSample sample;
  sample.t = *stamp;
  sample.has_fix = reader.number<std::int8_t>() != kNoFix;
  reader.number<std::uint16_t>();  // service
  sample.latitude_deg = reader.number<double>();
  sample.longitude_deg = reader.number<double>();
  sample.altitude_m = reader.number<double>();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const auto variance = reader.number<double>();
      if (row == column) sample.sigma_enu_m[row] = std::sqrt(variance);
    }
  }
  reader.number<std::uint8_t>();  // kind of covariance
  if (!reader.ok() || reader.left() != 0) return std::nullopt;
  return sample;
}

}  // namespace holdfast::io::ros
