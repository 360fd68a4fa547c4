#pragma once

#include <vector>

#include "simulation/motion/drive.hpp"

namespace holdfast::simulation {

/// How fast a robot may go at each place of a route so that it keeps its limits in turns and can
/// brake for them in time.
class SpeedLimit {
 public:
  SpeedLimit(const Route& route, const DriveStyle& style);
  /// m/s at length `s`, any real number.
  double at(double s) const;

 private:
  double length_;
  double step_;
  std::vector<double> speed_;
};

}  // namespace holdfast::simulation
