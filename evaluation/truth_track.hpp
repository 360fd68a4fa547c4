#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/core/se3.hpp"

namespace holdfast::evaluation {

using Trajectory = std::vector<StampedPose>;

/// What the truth says about one moment.
struct TruthSample {
  enum class Kind { kKnown, kOutside, kGap };
  Kind kind = Kind::kOutside;
  SE3 T_map_body;     ///< only if known
  double path_m = 0;  ///< way travelled since the first pose, without teleports and gaps
  int stretch = 0;    ///< counts up at every teleport and every gap

  bool known() const { return kind == Kind::kKnown; }
};

/// A true trajectory that can be asked for the pose at any time. Poses between two lines are
/// interpolated (straight, constant rate of turn), but never across a teleport (two lines with one
/// stamp; the later line is valid from that stamp on) and never across a gap in the recording.
class TruthTrack {
 public:
  /// `poses` in order of time (equal stamps: a teleport). A gap is a pause of more than
  /// `max_gap_s`, or, for a truth that is recorded more slowly than that, of more than 1.5 of its
  /// own median periods, but never of more than 0.25 s, where interpolation stops being a truth.
  explicit TruthTrack(Trajectory poses, double max_gap_s = 0.1);

  bool empty() const { return poses_.empty(); }
  const Trajectory& poses() const { return poses_; }
  TimeNs begin_time() const { return poses_.front().t; }
  TimeNs end_time() const { return poses_.back().t; }
  double max_gap_s() const { return to_seconds(max_gap_); }
  /// Median time between two lines; 0 with fewer than two.
  double period_s() const { return period_s_; }
  /// Way from the first to the last pose in metres.
  double length_m() const { return path_m_.empty() ? 0 : path_m_.back(); }

  /// True if a teleport or a gap lies between pose i - 1 and pose i (i >= 1).
  bool broken_before(std::size_t i) const { return broken_after(i - 1); }
  /// Cost: one binary search.
  TruthSample at(TimeNs t) const;

 private:
  TruthSample sample_of(std::size_t i) const;
  bool broken_after(std::size_t i) const;
  void measure_path();

  Trajectory poses_;
  TimeNs max_gap_ = 0;
  double period_s_ = 0;
  std::vector<double> path_m_;
  std::vector<int> stretch_;
};

}  // namespace holdfast::evaluation
