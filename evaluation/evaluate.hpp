#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/event_scores.hpp"
#include "evaluation/relative_error.hpp"
#include "evaluation/scan_list.hpp"
#include "evaluation/statistics.hpp"
#include "holdfast/core/result.hpp"

/// How good a trajectory is. The words are those of DESIGN.md, section 7.
namespace holdfast::evaluation {

enum class Alignment {
  kNone,   ///< the claim is a pose in the map
  kRigid,  ///< best rigid fit first (Umeyama, without scale), for an odometry
};

struct EvaluationOptions {
  Alignment align = Alignment::kNone;
  double max_truth_gap_s = 0.1;  ///< see TruthTrack
  double warm_up_s = 2.0;        ///< shares leave out the scans before this
  PoseTolerance success = {0.3, 5.0};
  PoseTolerance misleading = {0.5, 5.0};
};

/// What is known besides the two trajectories.
struct RunContext {
  std::string estimate_name = "the estimate";  ///< for messages
  std::string truth_name = "the truth";
  std::vector<StepRow> steps;  ///< empty: unknown; every claim counts as TRACKING
  /// The estimate is RUN/odometry.tum: statuses in `steps` do not apply to it, and no drift is
  /// measured across its breaks.
  bool is_odometry = false;
  std::vector<Event> events;      ///< what was done to the robot
  std::vector<Event> run_events;  ///< what the run reported
};

struct Evaluation {
  // What there was to judge
  std::size_t scans = 0;          ///< scans due
  std::size_t claimed = 0;        ///< scans with a pose
  std::size_t judged = 0;         ///< claims with truth: what the errors are over
  std::size_t outside_truth = 0;  ///< claims before the first or after the last line of the truth
  std::size_t in_truth_gap = 0;   ///< claims in a gap of the truth
  bool from_steps = false;        ///< scans due and statuses are those of steps.csv
  TimeNs begin = 0;               ///< first scan
  TimeNs end = 0;                 ///< last scan
  double path_m = 0;              ///< true way, teleports left out

  // Errors over judged claims
  ErrorStatistics trans_m;
  ErrorStatistics rot_deg;
  std::optional<double> e2e_m;  ///< at the last scan; none: no claim or no truth there
  std::optional<double> e2e_deg;
  std::array<RelativeError, 3> drift;  ///< over 10, 20 and 50 m

  // Shares of the scans after the warm-up. `success`, `misleading` only of scans with truth.
  Share coverage;
  Share success;
  Share misleading;
  Share trusted;  ///< TRACKING or DEGRADED

  std::vector<EventScore> events;
  std::vector<RelocalizationScore> relocalizations;
  std::size_t false_relocalizations = 0;

  Alignment align = Alignment::kNone;
  SE3 T_truth_estimate;  ///< the alignment; identity without
  double truth_period_s = 0;
  std::vector<ScanRecord> series;     ///< every scan
  std::vector<std::string> warnings;  ///< sentences: what was left out or guessed
};

/// Judges `estimate` against `truth` (both in order of time). Errors: the truth is empty; the two
/// do not overlap in time (both spans are given, and a wrong unit of time is named when it fits);
/// every claim falls into gaps of the truth; an empty estimate without steps. An empty estimate
/// with steps is no error but a run that claimed nothing. Deterministic.
Result<Evaluation> evaluate(const Trajectory& estimate, const Trajectory& truth,
                            const EvaluationOptions& options = {}, const RunContext& context = {});

struct EvaluationPaths {
  std::filesystem::path estimate;  ///< steps.csv and events.jsonl beside it are used if present
  std::filesystem::path truth;
  std::filesystem::path events;  ///< empty: none
};

/// Reads the files and judges. The steps.csv and events.jsonl of a run are used only if the
/// estimate is called trajectory.tum or odometry.tum, as a run calls them.
Result<Evaluation> evaluate_files(const EvaluationPaths& paths, const EvaluationOptions& options);

}  // namespace holdfast::evaluation
