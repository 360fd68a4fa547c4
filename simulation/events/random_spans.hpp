#pragma once

#include <vector>

#include "holdfast/core/random.hpp"
#include "simulation/events/time_span.hpp"

namespace holdfast::simulation {

/// Spans of time that begin at random, so many a minute between them, and last `mean_s` on average;
/// gaps and lengths are exponentially distributed. They end with the log. None for a rate of zero.
std::vector<TimeSpan> draw_spans(double per_minute, double mean_s, TimeNs length,
                                 RandomStream random);

/// Whether one of the spans holds `t`.
bool any_contains(const std::vector<TimeSpan>& spans, TimeNs t);

}  // namespace holdfast::simulation
