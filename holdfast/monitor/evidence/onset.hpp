#pragma once

#include <array>
#include <optional>

#include "holdfast/core/time.hpp"

namespace holdfast::monitor {

/// A sign that the robot was carried away just now.
struct Onset {
  bool odometry_broke = false;  ///< the odometry says so
  double drop = 0;              ///< of the share that agrees with the map, against two scans before
  double log_ratio = 0;         ///< ln of how much likelier that drop is if it was carried
};

/// People, doors and corners hide the map little by little; a robot that is carried away sees
/// something else from one scan to the next (the scan in between is half of each).
class OnsetWatch {
 public:
  /// The share at time `t`; none: no returns.
  Onset watch(TimeNs t, std::optional<double> agreeing_share, bool odometry_broke);

 private:
  struct Seen {
    TimeNs t = 0;
    double share = 0;
  };

  std::array<std::optional<Seen>, 2> before_;  ///< the older one first
};

}  // namespace holdfast::monitor
