#include "evaluation/report/map_points.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace holdfast::evaluation {
namespace {

constexpr double kLargestInteger = 65535;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t bits =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += kLetters[bits >> 18];
    text += kLetters[bits >> 12 & 63];
    text += left > 1 ? kLetters[bits >> 6 & 63] : '=';
    text += left > 2 ? kLetters[bits & 63] : '=';
  }
  return text;
}

}  // namespace

nlohmann::ordered_json map_points_json(const MapView& map) {
  if (map.points.empty()) return nullptr;
  Eigen::Vector3f low = map.points.front();
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& point : map.points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector3d min = low.cast<double>();
  const Eigen::Vector3d step = (high - low).cast<double>().cwiseMax(1e-3) / kLargestInteger;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(6 * map.points.size());
  for (const Eigen::Vector3f& point : map.points) {
    const Eigen::Vector3d place = (point.cast<double>() - min).cwiseQuotient(step);
    for (const double value : place) {
      const auto integer = static_cast<std::uint16_t>(std::lround(value));
      bytes.push_back(static_cast<std::uint8_t>(integer & 255));
      bytes.push_back(static_cast<std::uint8_t>(integer >> 8));
    }
  }
  return {{"count", map.points.size()},
          {"min", {min.x(), min.y(), min.z()}},
          {"step", {step.x(), step.y(), step.z()}},
          {"xyz", base64(bytes)}};
}

}  // namespace holdfast::evaluation
