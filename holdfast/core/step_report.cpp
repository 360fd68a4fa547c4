#include "holdfast/core/step_report.hpp"

namespace holdfast {

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 8> kNames = {"INITIALIZING",   "TRACKING",    "DEGRADED",
                                                      "DEAD_RECKONING", "UNMAPPED",    "SUSPECT",
                                                      "LOST",           "RELOCALIZING"};
  return kNames[static_cast<std::size_t>(state)];
}

}  // namespace holdfast
