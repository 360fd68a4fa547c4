#include "holdfast/relocalization/search_report.hpp"

#include <algorithm>

namespace holdfast::relocalization {

const char* name_of(SearchOutcome outcome) {
  switch (outcome) {
    case SearchOutcome::kFound: return "found";
    case SearchOutcome::kAmbiguous: return "ambiguous";
    case SearchOutcome::kNothing: return "nothing";
    case SearchOutcome::kTooPoor: return "too poor";
    case SearchOutcome::kOutOfWork: break;
  }
  return "out of work";
}

double SearchReport::p_none() const {
  double p = 1.0;
  for (const Candidate& c : candidates) p -= c.probability;
  return std::max(p, 0.0);
}

bool SearchReport::fits(const Candidate& candidate) const {
  constexpr double kLeastOdds = 9.0;
  return candidate.probability >= kLeastOdds * p_none();
}

bool SearchReport::any_fits() const {
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](const Candidate& c) { return fits(c); });
}

}  // namespace holdfast::relocalization
