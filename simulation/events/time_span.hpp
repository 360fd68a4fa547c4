#pragma once

#include "holdfast/core/time.hpp"

namespace holdfast::simulation {

/// A span of time, from the start of the log.
struct TimeSpan {
  TimeNs begin = 0;
  TimeNs end = 0;  ///< the first time after it

  bool contains(TimeNs t) const { return begin <= t && t < end; }
};

}  // namespace holdfast::simulation
