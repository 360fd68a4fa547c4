#pragma once

#include <optional>

#include "holdfast/core/time.hpp"
#include "holdfast/monitor/evidence/belief.hpp"
#include "holdfast/monitor/evidence/running_usual.hpp"
#include "holdfast/monitor/monitor_config.hpp"

namespace holdfast::monitor {

/// What the monitor is told after a scan.
struct HealthInput {
  TimeNs t = 0;
  double way_m = 0;                            ///< since the scan before
  bool odometry_broke = false;                 ///< it says that the robot was carried
  std::optional<Looks> looks;                  ///< none: the scan has no returns
  std::optional<UsualLooks> usual;             ///< of the place, by the map; none: of this run
  std::optional<double> way_squared_distance;  ///< of the map's poses from the odometry
};

enum class Verdict : std::uint8_t { kHealthy, kSuspect, kLost };

struct Health {
  Verdict verdict = Verdict::kHealthy;
  double p_wrong = 0;    ///< that the pose is of another place
  double p_outside = 0;  ///< that the pose is right, and the map has little of what is here
  double p_hidden = 0;   ///< that the pose is right, and people or changes hide the map
  Onset onset;           ///< the strongest of the last seconds
  std::optional<Looks> seen;
  std::optional<UsualLooks> usual;  ///< what that was held against
  /// Of each witness, how much more likely its words are at a wrong pose than at a right one (its
  /// natural logarithm); 0 for one that has said nothing.
  std::array<double, kWitnessNames.size()> log_ratio{};
};

/// Tells whether the pose is right, from witnesses that do not share the registration's errors: how
/// much of the scan agrees with the map, rays that pass through walls, returns where the map has
/// nothing, and the odometry's way and breaks (design, section 4; the article's residuals and
/// jumps, 3.4.1, are DualIndexDetector). The same inputs give the same bits.
class HealthMonitor {
 public:
  explicit HealthMonitor(const MonitorConfig& config) : config_(config), belief_(config.belief) {}

  Health judge(const HealthInput& input);

 private:
  void remember(const Onset& onset, TimeNs t);
  void hear(const HealthInput& input, Health& health);
  Verdict verdict(double p_wrong) const;

  MonitorConfig config_;
  Belief belief_;
  OnsetWatch watch_;
  Onset onset_;  ///< the strongest of late
  TimeNs onset_time_ = 0;
  RunningUsual run_;
  TimeNs before_ = 0;
  Verdict last_ = Verdict::kHealthy;
};

}  // namespace holdfast::monitor
