#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/log_file.hpp"
#include "holdfast/pipeline/config.hpp"

namespace holdfast::apps {

/// Options of every command that runs the system on a log.
struct RunOptions {
  std::string config_file;
  std::vector<std::string> assignments;
  std::string points_topic;
  std::string imu_topic;
  std::string scans;
  int threads = 1;

  void add_to(CLI::App& command);

  /// The configuration; without --config, the config.yaml beside the log is taken if there is one.
  Result<pipeline::Config> load(const std::string& log) const;
  Result<io::LogOptions> log_options() const;
};

/// Parses "x y z qx qy qz qw" (commas allowed).
Result<SE3> parse_pose(const std::string& text);

/// Unwraps a result or ends the command with exit code `code`.
template <class T>
T value_or_fail(Result<T> result, int code = 1);

}  // namespace holdfast::apps

#include "apps/commands.hpp"

namespace holdfast::apps {

template <class T>
T value_or_fail(Result<T> result, int code) {
  if (!result) throw CommandFailed{code, result.error().message};
  return std::move(result).value();
}

}  // namespace holdfast::apps
