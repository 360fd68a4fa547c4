#include "holdfast/monitor/running_usual.hpp"

#include <algorithm>

namespace holdfast::monitor {
namespace {

constexpr double kMostWorth = 30;
constexpr double kScansALook = 10;  // a second of scans sees one view
constexpr double kSlowest = 0.01;   // of learning: 10 s of scans

}  // namespace

void RunningUsual::learn(const Looks& seen) {
  usual_.worth = std::min(kMostWorth, usual_.worth + 1.0 / kScansALook);
  const double share = std::max(kSlowest, 1.0 / (usual_.worth * kScansALook));
  Looks& mean = usual_.mean;
  mean.agreeing += share * (seen.agreeing - mean.agreeing);
  mean.through += share * (seen.through - mean.through);
  mean.unmapped += share * (seen.unmapped - mean.unmapped);
}

}  // namespace holdfast::monitor
