#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/statistics.hpp"
#include "holdfast/core/result.hpp"
#include "holdfast/core/step_report.hpp"
#include "holdfast/core/time.hpp"

/// Readers of what a run leaves behind: RUN/steps.csv and RUN/summary.json.
namespace holdfast::evaluation {

/// One scan of a run. Figures that the file leaves empty are NaN.
struct StepRow {
  TimeNs stamp = 0;
  TimeNs pose_time = 0;
  std::string status;  ///< name of a State
  std::string reason;
  double p_wrong = kNotKnown;
  double matches = kNotKnown;
  double inlier_share = kNotKnown;
  double mean_abs_residual_m = kNotKnown;
  /// Declared with DEGRADED: unit vectors in the map frame along which the position is uncertain.
  std::vector<Eigen::Vector3d> weak_directions;
  double sigma_trans_m = kNotKnown;
  double sigma_rot_rad = kNotKnown;
  std::int64_t odom_epoch = 0;
  double ms_total = kNotKnown;
  std::vector<double> ms_stages;  ///< in the order of StepTable::stages
};

/// The state of that name; none for other words.
std::optional<State> state_of(const std::string& status);
/// Statuses in which RUN/trajectory.tum has a line.
bool status_claims_pose(const std::string& status);
/// TRACKING or DEGRADED: the robot is told that it may rely on the pose.
bool status_is_trusted(const std::string& status);

struct StepTable {
  std::vector<std::string> stages;  ///< "deskew" for a column "ms_deskew"
  std::vector<StepRow> rows;
  bool truncated = false;  ///< the last line was cut off and is left out
};

/// Reads steps.csv by its header line: columns in any order, unknown ones ignored, empty values
/// allowed except in pose_time and status (stamp defaults to pose_time). A last line without an end
/// is dropped when it cannot be read (the run was killed). Weak directions are written as
/// "(x y z);(x y z)"; other text there declares none. Errors name file, line, column, what was
/// expected and found; pose times that do not grow are an error.
Result<StepTable> read_steps(const std::filesystem::path& path);

struct Percentiles {
  double p50 = kNotKnown;
  double p95 = kNotKnown;
  double p99 = kNotKnown;
  double max = kNotKnown;
};

/// RUN/summary.json. Keys that are absent stay NaN or empty.
struct RunSummary {
  double scans = kNotKnown;
  double duration_s = kNotKnown;
  Percentiles step_ms;  ///< thread CPU time
  Percentiles step_wall_ms;
  double peak_rss_mb = kNotKnown;
  double relocalizations = kNotKnown;
  double realtime_factor = kNotKnown;
  std::string method;
  std::vector<std::pair<std::string, double>> status_share;
  /// Everything under "counters", nested objects joined by a dot; flags count 0 or 1.
  std::vector<std::pair<std::string, double>> counters;
  std::vector<std::string> warnings;
};

/// Errors name the file and, for broken JSON, the byte.
Result<RunSummary> read_summary(const std::filesystem::path& path);

}  // namespace holdfast::evaluation
