#include <cmath>
#include <numbers>
#include <string>

#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/input_file.hpp"
#include "holdfast/io/files/numbers.hpp"
#include "holdfast/io/kitti_raw.hpp"
#include "holdfast/io/logs/kitti_files.hpp"

namespace holdfast::io {
namespace {

namespace fs = std::filesystem;
using files::error_at;

constexpr double kEarthRadiusM = 6378137.0;  // WGS 84, equator

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// East and north on the Mercator map; times cos(latitude) these are metres near that latitude.
Eigen::Vector2d mercator(double latitude_deg, double longitude_deg) {
  const double north = std::log(std::tan(std::numbers::pi / 4 + radians(latitude_deg) / 2));
  return kEarthRadiusM * Eigen::Vector2d(radians(longitude_deg), north);
}

/// Columns of an OXTS file.
enum : std::size_t { kLatitude, kLongitude, kAltitude, kRoll, kPitch, kYaw };

Eigen::Quaterniond attitude(const std::vector<double>& oxts) {
  using Eigen::AngleAxisd;
  return AngleAxisd(oxts[kYaw], Eigen::Vector3d::UnitZ()) *
         AngleAxisd(oxts[kPitch], Eigen::Vector3d::UnitY()) *
         AngleAxisd(oxts[kRoll], Eigen::Vector3d::UnitX());
}

/// The numbers behind `key` in a calibration file.
Result<std::vector<double>> read_key(const fs::path& path, std::string_view text,
                                     std::string_view key, std::size_t count) {
  std::string_view line;
  while (files::take_line(text, line)) {
    const auto words = files::split_words(line);
    if (words.empty() || words[0] != key) continue;
    std::vector<double> values;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto value = files::parse_double(words[i]);
      if (!value || !std::isfinite(*value)) {
        return error_at(path, "{} '{}' is not a finite number", key, words[i]);
      }
      values.push_back(*value);
    }
    if (values.size() == count) return values;
    return error_at(path, "{} has {} values, expected {}", key, values.size(), count);
  }
  return error_at(path, "has no line '{}'", key);
}

}  // namespace

Result<std::vector<StampedPose>> read_kitti_truth(const fs::path& path) {
  const auto drive = logs::find_drive(path);
  if (!drive) return drive.error();
  const auto samples = logs::list_timed_files(*drive / "oxts", "timestamps.txt");
  if (!samples) return samples.error();
  std::vector<StampedPose> poses;
  double scale = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const auto& sample : *samples) {
    const auto oxts = logs::read_oxts(sample.path);
    if (!oxts) return oxts.error();
    if (!poses.empty() && sample.t <= poses.back().t) continue;
    if (poses.empty()) scale = std::cos(radians((*oxts)[kLatitude]));
    StampedPose pose;
    pose.t = sample.t;
    pose.T_map_body.translation << scale * mercator((*oxts)[kLatitude], (*oxts)[kLongitude]),
        (*oxts)[kAltitude];
    pose.T_map_body.rotation = attitude(*oxts);
    if (!pose.T_map_body.translation.allFinite() ||
        !pose.T_map_body.rotation.coeffs().allFinite()) {
      return error_at(sample.path, "does not hold a pose: values are not finite");
    }
    if (poses.empty()) first = pose.T_map_body.translation;
    pose.T_map_body.translation -= first;
    poses.push_back(pose);
  }
  return poses;
}

Result<SE3> read_kitti_extrinsics(const fs::path& path) {
  const auto drive = logs::find_drive(path);
  if (!drive) return drive.error();
  std::error_code error;
  const auto absolute = fs::absolute(*drive, error);
  const auto file = absolute.parent_path() / "calib_imu_to_velo.txt";
  const auto text = files::read_text(file);
  if (!text) return text.error();
  const auto r = read_key(file, *text, "R:", 9);
  if (!r) return r.error();
  const auto t = read_key(file, *text, "T:", 3);
  if (!t) return t.error();
  const Eigen::Matrix3d R_lidar_body =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r->data());
  if (!(R_lidar_body * R_lidar_body.transpose()).isIdentity(1e-3) ||
      R_lidar_body.determinant() < 0) {
    return error_at(file, "R: is not a rotation matrix");
  }
  const SE3 T_lidar_body{Eigen::Quaterniond(R_lidar_body).normalized(),
                         Eigen::Map<const Eigen::Vector3d>(t->data())};
  return T_lidar_body.inverse();
}

}  // namespace holdfast::io
