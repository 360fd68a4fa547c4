#include "holdfast/monitor/evidence/running_usual.hpp"

#include <algorithm>

namespace holdfast::monitor {
namespace {

constexpr int kFewestScans = 20;
constexpr double kMemory = 100;  // scans

}  // namespace

std::optional<UsualLooks> RunningUsual::looks() const {
  if (scans_ < kFewestScans) return std::nullopt;
  return mean_;
}

void RunningUsual::learn(const Looks& seen) {
  ++scans_;
  const double share = 1.0 / std::min<double>(kMemory, scans_);
  mean_.paired += share * (seen.paired - mean_.paired);
  mean_.through += share * (seen.through - mean_.through);
  mean_.unmapped += share * (seen.unmapped - mean_.unmapped);
}

}  // namespace holdfast::monitor
