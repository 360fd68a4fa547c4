#include "simulation/world/material.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {

double Material::return_probability(double cos_incidence) const {
  const double cosine = std::clamp(cos_incidence, 0.0, 1.0);
  double probability = diffuse_return;
  if (cosine < grazing_cos) probability *= cosine / grazing_cos;
  if (mirror_return > 0) {
    probability +=
        mirror_return * std::exp(-2 * (1 - cosine) / (mirror_lobe_rad * mirror_lobe_rad));
  }
  return std::min(1.0, probability);
}

}  // namespace holdfast::simulation
