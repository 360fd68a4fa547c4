#include "holdfast/filter/matching/point_demand.hpp"

#include <algorithm>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::filter {

preprocess::ScanSelectionConfig PointDemand::next(
    const preprocess::ScanSelectionConfig& usual) const {
  preprocess::ScanSelectionConfig limits = usual;
  if (more_) limits.max_points = std::max(usual.max_points, usual.most_points);
  return limits;
}

void PointDemand::learn(const registration::NormalEquations& told, std::size_t matched,
                        const preprocess::ScanSelectionConfig& usual) {
  if (!more_) usual_ = matched;
  // The usual number would have told less by this share, and of that less would be believed
  // (registration::feigned_information): the deviation would be as much larger, not its square.
  const double share = static_cast<double>(usual_) / static_cast<double>(matched);
  const double sigma_m = usual.poor_sigma_m * std::min(1.0, share);
  more_ = !registration::weak_directions(told, sigma_m).empty();
}

}  // namespace holdfast::filter
