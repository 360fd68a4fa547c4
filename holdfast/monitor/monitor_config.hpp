#pragma once

#include <limits>
#include <string>

#include "holdfast/monitor/evidence/belief.hpp"

namespace holdfast::monitor {

struct MonitorConfig {
  std::string method = "evidence";
  double suspect_p = 0.2;
  double lost_p = 0.9;
  int rays = 120;
  BeliefConfig belief;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    visit("method", self.method,
          FieldDoc{"how a wrong pose is noticed: from independent witnesses (evidence; method: "
                   "graph only), by residuals and jumps (dual_index: article 3.4.1; every "
                   "method), or not at all (off)",
                   -kAny, kAny, "evidence|dual_index|off"});
    visit("suspect_p", self.suspect_p,
          FieldDoc{
              "probability that the pose is wrong, from which it is SUSPECT (1 / 5: a wrong claim "
              "costs four times as much as none)",
              1e-6, 1.0});
    visit("lost_p", self.lost_p,
          FieldDoc{"from which it is LOST, until it is below suspect_p again", 1e-6, 1.0});
    visit("rays", self.rays,
          FieldDoc{"rays of a scan that are followed through the map", 10, 100000});
  }
};

}  // namespace holdfast::monitor
