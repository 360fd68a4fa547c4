#include "holdfast/monitor/evidence/looks.hpp"

#include <algorithm>

namespace holdfast::monitor {
namespace {

double share(double part, double of) { return of > 0 ? std::clamp(part / of, 0.0, 1.0) : 0.0; }

}  // namespace

Looks looks_of(double weight, double pairs, double points, const SightCounts& sight) {
  return {share(weight, pairs), share(pairs, points), share(sight.through, sight.lines),
          share(sight.unmapped, sight.lines - sight.through)};
}

}  // namespace holdfast::monitor
