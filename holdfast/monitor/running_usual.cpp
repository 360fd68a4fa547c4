#include "holdfast/monitor/running_usual.hpp"

#include <algorithm>

namespace holdfast::monitor {
namespace {

constexpr int kFewestScans = 20;
constexpr double kWorth = 15;    // looks: the next place may be another sort
constexpr double kMemory = 100;  // scans

}  // namespace

std::optional<UsualLooks> RunningUsual::looks() const {
  if (scans_ < kFewestScans) return std::nullopt;
  return UsualLooks{mean_, kWorth};
}

void RunningUsual::learn(const Looks& seen) {
  ++scans_;
  const double share = 1.0 / std::min<double>(kMemory, scans_);
  mean_.agreeing += share * (seen.agreeing - mean_.agreeing);
  mean_.through += share * (seen.through - mean_.through);
  mean_.unmapped += share * (seen.unmapped - mean_.unmapped);
}

}  // namespace holdfast::monitor
