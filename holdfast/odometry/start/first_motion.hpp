#pragma once

#include <vector>

#include "holdfast/filter/scan_update.hpp"
#include "holdfast/odometry/edges/edge_ways.hpp"
#include "holdfast/odometry/surroundings/local_map.hpp"

namespace holdfast::odometry {

/// The scan with which a local map begins, kept until the second one has told how fast the robot
/// was.
struct FirstScan {
  Scan scan;
  filter::SelectedScan selected;  ///< of `scan`
  filter::FilterState state;      ///< at the end of the scan; velocity: a guess
  std::vector<SeenEdge> edges;
  bool may_rest = true;  ///< false: the IMU felt that the robot moves
};

/// Empties `map` and puts the first scan into it, moved as a robot that goes at `v_odom` saw it.
void begin_map(const FirstScan& first, const Eigen::Vector3d& v_odom,
               const Eigen::Vector3d& gravity, LocalMap& map, filter::UpdateWorkspace& work);

enum class FirstMotion {
  kNone,   ///< the scans have too little in common
  kRests,  ///< nothing speaks against a robot that stands still
  kMoves,
};

/// What the search for the first motion works with.
struct SearchTools {
  const filter::UpdateOptions& options;
  const filter::ScanPairing& pairing;  ///< with `map`
  WorkerPool& pool;
  LocalMap& map;  ///< of the first scan, as a robot at rest saw it; changed by the search
  filter::UpdateWorkspace& work;
};

/// Velocity of the robot at the end of the first scan, in the odometry's frame, from the way to the
/// second one; set in `first.state`, with its covariance. Neither scan can be deskewed without it,
/// but both are skewed nearly alike while the robot goes on as it does: so the second is matched to
/// the first with both left skewed, and then again moved by what that told. Ways up to `longest_m`
/// are tried in which planes or edges meet, and the shortest stands that no other explains better;
/// rest before all, or the guess where it cannot be rest. `edges`: of the second scan.
FirstMotion find_first_motion(FirstScan& first, const filter::SelectedScan& second,
                              TimeNs second_end, const std::vector<SeenEdge>& edges,
                              double longest_m, const Eigen::Vector3d& gravity, SearchTools tools);

}  // namespace holdfast::odometry
