#pragma once

#include <memory>
#include <vector>

#include "benchmarks/drives/surveyed_drive.hpp"
#include "holdfast/features/features.hpp"
#include "holdfast/registration/fit_at_query.hpp"

namespace holdfast::benchmarks {

/// How much a drive's scans hold, in the article's terms (4.1.1): one figure a scan.
struct ScanCounts {
  std::vector<double> returns;
  std::vector<double> edge_matches, plane_matches;
  std::vector<double> occluded;  ///< share of a scan's returns from who or what moves

  std::size_t scans() const { return returns.size(); }
  /// Share of the scans with fewer matches than "valid matching requires N_E >= 10 (number of edge
  /// point matches) and N_F >= 20 (number of planar point matches)" (3.2.2).
  double few_edges() const;
  double few_planes() const;
  double few_of_either() const;  ///< in the hall "18.3 % of frames" (4.1.1)
};

/// Counts a drive's scans. Matches are those that the article's registration begins with: its
/// features, by `log` as the print yields none (holdfast/features/features.hpp), at their true
/// places against the lines and planes of the drive's own survey.
class ScanCensus {
 public:
  /// `drive` is used later and must outlive this. Errors are those of the map's files.
  static Result<ScanCensus> create(SurveyedDrive& drive);

  /// The next scan of the drive: its features by `log`, and what is true of its returns.
  void add(const Scan& scan, const features::Features& found,
           const std::vector<simulation::TrueReturn>& truth, ScanCounts& counts) const;

 private:
  ScanCensus(SurveyedDrive& drive, const Eigen::Vector3d& origin,
             registration::FitAtQuery matching);

  SurveyedDrive* drive_;
  Eigen::Vector3d origin_;  ///< of the map
  registration::FitAtQuery matching_;
};

}  // namespace holdfast::benchmarks
