#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/se3.hpp"

namespace holdfast::monitor {

struct DualIndexConfig {
  double residual_sigmas = 2.0;
  int history_scans = 50;
  int least_history_scans = 10;
  double fixed_threshold_m = 0.0;
  double outright_factor = 2.0;
  double jump_m = 0.5;
  double jump_deg = 10.0;
  std::string jump_from = "body";
  int confirm_scans = 3;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    visit("residual_sigmas", self.residual_sigmas,
          FieldDoc{"alpha: a mean residual so many standard deviations above the mean of the last "
                   "scans makes a candidate",
                   0.0, 100.0});
    visit("history_scans", self.history_scans,
          FieldDoc{"scans whose residuals are remembered", 2, 10000});
    visit("least_history_scans", self.least_history_scans,
          FieldDoc{"with fewer, no residual makes a candidate", 2, 10000});
    visit("fixed_threshold_m", self.fixed_threshold_m,
          FieldDoc{"a fixed limit of the mean residual instead (Table 7: 0.15); 0: none", 0.0,
                   100.0});
    visit("outright_factor", self.outright_factor,
          FieldDoc{"one scan with a residual above so many thresholds is an anomaly", 1.0, 1e6});
    visit("jump_m", self.jump_m,
          FieldDoc{"d_th: motion between two scans that is a jump", 1e-3, 1000.0});
    visit("jump_deg", self.jump_deg, FieldDoc{"likewise of the rotation", 1e-3, 180.0});
    visit("jump_from", self.jump_from,
          FieldDoc{"what motion is measured as: T_k T_k-1^-1, which has a lever arm about the "
                   "map's origin (printed); T_k-1^-1 T_k (body); or the way from the predicted to "
                   "the found pose (prediction)",
                   -kAny, kAny, "printed|body|prediction"});
    visit("confirm_scans", self.confirm_scans,
          FieldDoc{"consecutive candidates with jumps that are an anomaly", 1, 1000});
  }
};

/// What the detector looks at after a scan.
struct DualIndexInput {
  SE3 T_map_body;                         ///< found
  SE3 T_map_predicted;                    ///< what motion alone would have given
  std::optional<double> mean_residual_m;  ///< of absolute values; none: nothing was matched
  bool too_few_matches = false;           ///< N_E or N_F below their minimum (4.1.1)
};

/// What it says, with its evidence.
struct DualIndexVerdict {
  double threshold_m = std::numeric_limits<double>::infinity();  ///< of the mean residual
  double jump_m = 0;
  double jump_rad = 0;
  bool candidate = false;  ///< residual above the threshold, or too few matches
  bool jumped = false;
  bool anomaly = false;  ///< confirmed
};

/// The article's detector (3.4.1 and 4.1.1): a scan whose mean residual exceeds the mean of the
/// last 50 by two standard deviations, or that matches too little, is a candidate. An anomaly are
/// three consecutive candidates each with a jump of the pose, or one scan above twice the
/// threshold. The print leaves open whether a scan is part of the statistics it is held against (no
/// here), and what holds before there are any (nothing here).
class DualIndexDetector {
 public:
  explicit DualIndexDetector(const DualIndexConfig& config) : config_(config) {}

  DualIndexVerdict judge(const DualIndexInput& input);

  /// After a relocalization (3.4.2): forgets residuals, candidates and the pose before.
  void reset();

 private:
  double threshold_m() const;
  SE3 motion_to(const DualIndexInput& input) const;
  void remember(double residual_m);

  DualIndexConfig config_;
  std::vector<double> residuals_m_;  ///< the last ones, in a ring
  std::size_t oldest_ = 0;           ///< of the ring, once it is full
  std::optional<SE3> before_;
  int consecutive_ = 0;  ///< candidates with jumps
};

}  // namespace holdfast::monitor
