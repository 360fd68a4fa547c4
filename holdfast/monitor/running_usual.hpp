#pragma once

#include "holdfast/monitor/looks.hpp"

namespace holdfast::monitor {

/// What has been usual in this run, where the map does not say what is usual at a place. It is
/// worth less than the map's word: a pose that is wrong from the start teaches it wrong rates.
class RunningUsual {
 public:
  const UsualLooks& looks() const { return usual_; }

  /// A scan at a pose that is held to be right.
  void learn(const Looks& seen);

 private:
  UsualLooks usual_{{0.7, 0.06, 0.02}, kWorthUnseen};
  static constexpr double kWorthUnseen = 4;
};

}  // namespace holdfast::monitor
