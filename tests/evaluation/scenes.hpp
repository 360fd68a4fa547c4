#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/evaluate.hpp"
#include "holdfast/core/so3.hpp"

/// Drives whose errors are known in closed form.
namespace holdfast::evaluation::testing {

constexpr double kDegree = std::numbers::pi / 180;

/// Positions of some 100 m, held by doubles and rotated once or twice.
constexpr double kPositionRounding = 1e-12;
/// Angles from acos-free logarithms near zero, in degrees.
constexpr double kAngleRounding = 1e-9;

inline SE3 pose(double x, double y = 0, double z = 0, double yaw = 0) {
  return {so3::exp({0, 0, yaw}), {x, y, z}};
}

/// One pose each 1/`rate` s from `begin` to `end` (both included), as `where` says.
inline Trajectory sample(double begin, double end, double rate,
                         const std::function<SE3(double)>& where) {
  Trajectory poses;
  const auto count = std::llround((end - begin) * rate);
  for (std::int64_t i = 0; i <= count; ++i) {
    const TimeNs t = from_seconds(begin) + i * from_seconds(1 / rate);
    poses.push_back({t, where(to_seconds(t))});
  }
  return poses;
}

/// Along x at 1 m/s.
inline SE3 straight(double t) { return pose(t); }

/// Circle of 10 m radius at 1 m/s.
inline SE3 circle(double t) {
  const double angle = t / 10;
  return pose(10 * std::cos(angle), 10 * std::sin(angle), 0, angle + std::numbers::pi / 2);
}

/// Truth at 200 Hz.
inline Trajectory truth_of(double end, const std::function<SE3(double)>& where) {
  return sample(0, end, 200, where);
}

inline StepRow step(double t, const std::string& status) {
  StepRow row;
  row.stamp = from_seconds(t) - kSecond / 10;
  row.pose_time = from_seconds(t);
  row.status = status;
  return row;
}

/// Steps at 10 Hz from `begin` to `end` with the status that `status` gives.
inline std::vector<StepRow> steps(double begin, double end,
                                  const std::function<std::string(double)>& status) {
  std::vector<StepRow> rows;
  for (const StampedPose& p : sample(begin, end, 10, straight))
    rows.push_back(step(to_seconds(p.t), status(to_seconds(p.t))));
  return rows;
}

/// The poses whose time `keep` accepts.
inline Trajectory only(const Trajectory& poses, const std::function<bool(double)>& keep) {
  Trajectory kept;
  for (const StampedPose& p : poses)
    if (keep(to_seconds(p.t))) kept.push_back(p);
  return kept;
}

/// A folder of the running test, removed with what is in it.
class RunFolder {
 public:
  RunFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("holdfast_evaluation_" + std::to_string(::getpid()) + "_" + test->name());
    std::filesystem::create_directories(path_);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder() { std::filesystem::remove_all(path_); }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  std::filesystem::path put(std::string_view name, std::string_view content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  std::string read(std::string_view name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

 private:
  std::filesystem::path path_;
};

}  // namespace holdfast::evaluation::testing
