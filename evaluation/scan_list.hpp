#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/files/run_files.hpp"
#include "evaluation/truth_track.hpp"

namespace holdfast::evaluation {

/// One scan that was due, with what was claimed for it and how wrong that was.
struct ScanRecord {
  TimeNs t = 0;        ///< pose time
  std::string status;  ///< empty if nothing is known about the scan
  bool claimed = false;
  SE3 T_map_body;  ///< the claim, after alignment if one was asked for
  TruthSample truth;
  double trans_error_m = kNotKnown;  ///< only if claimed and the truth is known
  double rot_error_deg = kNotKnown;
  /// Translation error outside of the directions that DEGRADED declared uncertain.
  double undeclared_error_m = kNotKnown;
  std::vector<Eigen::Vector3d> weak_directions;  ///< declared; unit vectors in the map frame
  std::int64_t odom_epoch = 0;
  std::ptrdiff_t row = -1;  ///< its row in steps.csv; -1: none
  bool counts = false;      ///< after the first seconds that shares leave out

  bool has_error() const { return claimed && truth.known(); }
};

/// Which scans were due, and what was odd about finding out.
struct ScanList {
  std::vector<ScanRecord> scans;  ///< in order of time
  bool from_steps = false;        ///< false: derived from the estimate's own period
  double period_s = 0.1;          ///< median time between two scans
  std::size_t claims_without_row = 0;
  std::size_t repeated_claims = 0;  ///< lines with the stamp of their predecessor, left out
};

/// Scans due according to the rows of steps.csv (claims are matched to rows to the millisecond;
/// claims without a row are scans of their own). With `trust_every_claim` (an odometry's file) the
/// statuses of the rows are not applied. Without any match `from_steps` is false and the list is
/// that of scans_from_period().
ScanList scans_from_steps(const Trajectory& estimate, const std::vector<StepRow>& rows,
                          bool trust_every_claim, const TruthTrack& truth);

/// Scans due at the median period of the estimate over the whole span of the truth: every hole
/// between claims, before the first and after the last is filled with scans without a claim. Every
/// claim counts as TRACKING.
ScanList scans_from_period(const Trajectory& estimate, const TruthTrack& truth);

}  // namespace holdfast::evaluation
