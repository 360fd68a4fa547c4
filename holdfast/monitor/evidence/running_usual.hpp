#pragma once

#include <optional>

#include "holdfast/monitor/evidence/looks.hpp"

namespace holdfast::monitor {

/// What has been usual in this run, where the map does not say what is usual at a place. It is
/// worth less than the map's word: a pose that is wrong from the start teaches it wrong rates.
class RunningUsual {
 public:
  /// None before it has seen two seconds of scans.
  std::optional<UsualLooks> looks() const;

  /// A scan at a pose that nothing speaks against.
  void learn(const Looks& seen);

 private:
  int scans_ = 0;
  UsualLooks mean_{0, 0, 0, 15};  ///< the next place may be another sort
};

}  // namespace holdfast::monitor
