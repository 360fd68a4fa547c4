#include "holdfast/relocalization/search_report.hpp"

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

}  // namespace holdfast::relocalization
