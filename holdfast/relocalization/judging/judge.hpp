#pragma once

#include <vector>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/places/places.hpp"
#include "holdfast/relocalization/judging/refiner.hpp"
#include "holdfast/relocalization/search_report.hpp"

namespace holdfast::relocalization {

/// What the planes of the map and the nearest place say of a refined pose. `map` is focused there.
/// None where no place is near.
std::optional<Candidate> look_from(const map::PriorMap& map, const places::Places& places,
                                   const Sight& sight, const Refined& refined);

/// Sorts the candidates, the likeliest first, and decides: fills in probabilities, outcome, pose
/// and reason.
void decide(double accept_probability, SearchReport& report);

}  // namespace holdfast::relocalization
