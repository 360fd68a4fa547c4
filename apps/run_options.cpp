#include "apps/run_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace holdfast::apps {

void RunOptions::add_to(CLI::App& command) {
  command.add_option("--config", config_file,
                     "YAML file with T_body_lidar and what differs from the defaults "
                     "(default: config.yaml beside the log)");
  command.add_option("--set", assignments, "module.key=value, over the file; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--points", points_topic, "topic of the point clouds (default: the only one)");
  command.add_option("--imu", imu_topic, "topic of the IMU (default: the only one)");
  command.add_option("--scans", scans, "START:STOP:STEP, scans of the log to use, as in Python");
  command.add_option("--threads", threads, "threads; the result does not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
}

Result<pipeline::Config> RunOptions::load(const std::string& log) const {
  std::string file = config_file;
  if (file.empty()) {
    const auto beside = std::filesystem::path(log).parent_path() / "config.yaml";
    if (std::filesystem::exists(beside)) file = beside.string();
  }
  return pipeline::load_config(file, assignments);
}

Result<io::LogOptions> RunOptions::log_options() const {
  io::LogOptions options;
  options.points_topic = points_topic;
  options.imu_topic = imu_topic;
  if (scans.empty()) return options;
  std::vector<std::string> parts;
  std::stringstream stream(scans + ":");
  for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
  std::int64_t* const targets[] = {&options.scan_start, &options.scan_stop, &options.scan_step};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i >= 3) return Error{fmt::format("--scans {}: expected START:STOP:STEP", scans)};
    if (parts[i].empty()) continue;
    char* end = nullptr;
    *targets[i] = std::strtoll(parts[i].c_str(), &end, 10);
    if (*end != '\0') {
      return Error{fmt::format("--scans {}: '{}' is not a whole number", scans, parts[i])};
    }
  }
  if (options.scan_start < 0 || options.scan_step < 1) {
    return Error{fmt::format("--scans {}: START >= 0 and STEP >= 1 expected", scans)};
  }
  return options;
}

Result<SE3> parse_pose(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::stringstream stream(spaced);
  std::vector<double> v;
  for (std::string word; stream >> word;) {
    char* end = nullptr;
    v.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0' || !std::isfinite(v.back())) {
      return Error{fmt::format("'{}' is not a number in the pose '{}'", word, text)};
    }
  }
  if (v.size() != 7) {
    return Error{
        fmt::format("a pose has 7 numbers, x y z qx qy qz qw; '{}' has {}", text, v.size())};
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1.0) > 0.01) {
    return Error{
        fmt::format("the quaternion of the pose '{}' has norm {:.3f}, not 1", text, q.norm())};
  }
  return SE3{q.normalized(), {v[0], v[1], v[2]}};
}

}  // namespace holdfast::apps
