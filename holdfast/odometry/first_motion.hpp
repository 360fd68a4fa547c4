#pragma once

#include "holdfast/filter/scan_update.hpp"
#include "holdfast/odometry/surroundings/local_map.hpp"

namespace holdfast::odometry {

/// The scan with which a local map begins, kept until the second one has told how fast the robot
/// was.
struct FirstScan {
  Scan scan;
  filter::SelectedScan selected;  ///< of `scan`
  filter::FilterState state;      ///< at the end of the scan; velocity: a guess
  bool kept = false;

  void keep(const filter::SelectedScan& from, const filter::FilterState& at);
};

/// Empties `map` and puts the first scan into it, moved with the velocity of `first.state`.
void begin_map(const FirstScan& first, const Eigen::Vector3d& gravity, LocalMap& map,
               filter::UpdateWorkspace& work);

enum class FirstMotion {
  kNone,   ///< the scans have too little in common
  kRests,  ///< nothing speaks against a robot that stands still
  kMoves,
};

/// Velocity of the robot at the end of the first scan, in the odometry's frame, from the way to the
/// second one; set in `first.state`. Neither scan can be deskewed without it, but both are skewed
/// alike while the robot goes on as it does: so the second is matched to the first with both left
/// skewed, from a pattern of displacements up to `fastest_m_s`, and the slowest motion stands that
/// no other explains better; rest before all. `pairing` pairs with `map`; leaves a map of that
/// motion.
FirstMotion find_first_motion(FirstScan& first, const filter::SelectedScan& second,
                              TimeNs second_end, double fastest_m_s, const Eigen::Vector3d& gravity,
                              const filter::UpdateOptions& options,
                              const filter::ScanPairing& pairing, WorkerPool& pool, LocalMap& map,
                              filter::UpdateWorkspace& work);

}  // namespace holdfast::odometry
