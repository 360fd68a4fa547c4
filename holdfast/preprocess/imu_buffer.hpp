#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "holdfast/core/sensor_data.hpp"

namespace holdfast::preprocess {

/// IMU readings over a span of time, with a reading exactly at each end.
struct ImuSegment {
  std::vector<ImuSample> samples;  ///< ascending; at least two when the span is not empty
  TimeNs held_ns =
      0;  ///< length of the span that no measurement covers: the nearest reading is held
  TimeNs measured_begin = INT64_MIN;  ///< the readings from here
  TimeNs measured_end = INT64_MAX;    ///< to here are measured or lie between measured ones
  TimeNs longest_gap_ns = 0;  ///< longest time between neighbouring readings inside the span
};

/// Recent IMU readings in ascending order of time.
class ImuBuffer {
 public:
  enum class Verdict { kTaken, kNotFinite, kOutOfOrder };

  /// Samples that are not finite, or not later than the last one, are refused and counted.
  Verdict add(const ImuSample& sample);

  bool empty() const { return samples_.empty(); }
  TimeNs latest() const { return samples_.empty() ? INT64_MIN : samples_.back().t; }

  /// Readings from `begin` to `end`, linearly interpolated at both ends. Outside of what was
  /// measured the nearest reading is held. `out` keeps its memory. Returns false without any
  /// reading.
  bool segment(TimeNs begin, TimeNs end, ImuSegment& out) const;

  /// Forgets readings that no segment from `t` on can need.
  void drop_before(TimeNs t);

  std::uint64_t refused_not_finite() const { return not_finite_; }
  std::uint64_t refused_out_of_order() const { return out_of_order_; }

 private:
  ImuSample at(TimeNs t) const;

  std::deque<ImuSample> samples_;
  std::uint64_t not_finite_ = 0;
  std::uint64_t out_of_order_ = 0;
};

}  // namespace holdfast::preprocess
