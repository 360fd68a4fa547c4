#pragma once

#include <limits>
#include <string>

#include "holdfast/core/fields.hpp"

namespace holdfast::pipeline {

/// When the map is searched for the pose, and with what.
struct RelocalizationConfig {
  std::string method = "search";
  int window_scans = 6;
  double scan_spacing_m = 0.5;
  double scan_spacing_deg = 20.0;
  double retry_s = 0.5;
  double ns_per_lookup = 4.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    visit(
        "method", self.method,
        FieldDoc{"how a lost robot is found: by a search of the whole map (search), or not at all "
                 "(off)",
                 -kAny, kAny, "search|off"});
    visit(
        "window_scans", self.window_scans,
        FieldDoc{"scans that are searched with, the newest and those before it since the robot is "
                 "lost (article 3.4.2: 6)",
                 1, 100});
    visit(
        "scan_spacing_m", self.scan_spacing_m,
        FieldDoc{"way between scans that are searched with: nearer ones see the same", 0.0, 10.0});
    visit("scan_spacing_deg", self.scan_spacing_deg,
          FieldDoc{"or rotation between them", 0.0, 180.0});
    visit("retry_s", self.retry_s,
          FieldDoc{"from a search without an answer to the next", 0.0, 60.0});
    visit("ns_per_lookup", self.ns_per_lookup,
          FieldDoc{"time of a search by its look-ups, after which it takes effect: counted and not "
                   "measured, so that a replay gives the same bits",
                   0.0, 1000.0});
  }
};

}  // namespace holdfast::pipeline
