#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "benchmarks/drives/surveyed_drive.hpp"
#include "holdfast/core/step_report.hpp"

namespace holdfast::benchmarks {

/// How a robot came not to know where it is.
enum class Loss {
  kKidnap,   ///< it stands elsewhere from one scan to the next
  kCarried,  ///< it was carried for 5 s, the LiDAR covered
  kStart,    ///< it was switched on and has no pose
};
constexpr std::string_view kLossNames[] = {"kidnap", "carried", "start"};

/// A loss, and how it was made up for until the next one.
struct Recovery {
  Loss loss = Loss::kKidnap;
  TimeNs t = 0;          ///< when the LiDAR sees the other place; of a start: its first scan
  TimeNs apart = 0;      ///< from when on no other place looks the same within noise
  bool aliased = false;  ///< `apart` is later than `t`
  /// From `apart` to the first of scans that are, for 2 s and at least 18 of them, trusted
  /// (TRACKING or DEGRADED) and at most 0.3 m and 5 degrees off.
  std::optional<double> found_after_s;
  int searches = 0;
  int false_relocalizations = 0;  ///< poses taken over that were more than 0.5 m or 5 degrees off
  double misleading_s = 0;        ///< in TRACKING and so far off
  double search_ms = 0;           ///< the longest search, CPU time
  double step_ms = 0;             ///< the longest step, thread CPU time
};

/// Scores `loss` by the steps from `loss.t` until `until`; `truth` gives T_map_body.
Recovery score_recovery(Recovery loss, const std::vector<StepReport>& steps, TimeNs until,
                        const std::function<SE3(TimeNs)>& truth);

/// A kidnap about every `every_s` seconds of a drive, at times drawn by its seed.
struct LossPlan {
  double every_s = 12;
  double first_s = 4;
};

/// Drives with kidnaps, every third one carried, in the world and map of `surveyed`, which was made
/// from `spec`; and once more, but there the robot is switched on without a pose at the end of
/// each.
Result<std::vector<Recovery>> recover_all(DriveSpec spec, const SurveyedDrive& surveyed,
                                          const LossPlan& plan);

}  // namespace holdfast::benchmarks
