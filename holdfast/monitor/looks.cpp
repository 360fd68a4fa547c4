#include "holdfast/monitor/looks.hpp"

#include <algorithm>

namespace holdfast::monitor {

Looks Looks::of(double agreeing_share, const SightCounts& sight) {
  const int short_of_walls = sight.lines - sight.through;
  Looks looks;
  looks.agreeing = std::clamp(agreeing_share, 0.0, 1.0);
  looks.through = sight.lines > 0 ? static_cast<double>(sight.through) / sight.lines : 0.0;
  looks.unmapped =
      short_of_walls > 0 ? static_cast<double>(sight.unmapped) / short_of_walls : 0.0;
  return looks;
}

}  // namespace holdfast::monitor
