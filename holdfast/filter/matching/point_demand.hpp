#pragma once

#include <cstddef>

#include "holdfast/preprocess/scan_selection.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {

/// How many points of a scan are worth being matched. Along the axis of a tunnel a few points on
/// niches and portals tell the pose: where the usual number leaves a direction hardly known, the
/// next scan is matched with more.
class PointDemand {
 public:
  /// Limits for the next scan, given those of a usual one.
  preprocess::ScanSelectionConfig next(const preprocess::ScanSelectionConfig& usual) const;

  /// What a scan that was matched with so many points told.
  void learn(const registration::NormalEquations& told, std::size_t matched,
             const preprocess::ScanSelectionConfig& usual);

 private:
  bool more_ = false;
  std::size_t usual_ = 0;  ///< points of the last scan that was matched with no more
};

}  // namespace holdfast::filter
