#include "simulation/events/random_spans.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {

std::vector<TimeSpan> draw_spans(double per_minute, double mean_s, TimeNs length,
                                 RandomStream random) {
  std::vector<TimeSpan> spans;
  if (per_minute == 0) return spans;
  const auto exponential = [&](double mean) {
    return from_seconds(-mean * std::log(1 - random.uniform()));
  };
  TimeNs t = exponential(60 / per_minute);
  while (t < length) {
    const TimeNs end = std::min(t + exponential(mean_s), length);
    spans.push_back({t, end});
    t = end + exponential(60 / per_minute);
  }
  return spans;
}

bool any_contains(const std::vector<TimeSpan>& spans, TimeNs t) {
  return std::any_of(spans.begin(), spans.end(),
                     [t](const TimeSpan& span) { return span.contains(t); });
}

}  // namespace holdfast::simulation
