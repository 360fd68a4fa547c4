#pragma once

#include "holdfast/core/fields.hpp"

namespace holdfast::relocalization {

struct SearchConfig {
  double accept_probability = 0.99;
  double lowest_m = -0.8;
  double highest_m = 1.2;
  double reach_m = 35.0;
  double most_work = 1e9;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("accept_probability", self.accept_probability,
          FieldDoc{"a pose that is this likely among all that explain what is seen is the answer",
                   0.5, 1.0});
    visit("lowest_m", self.lowest_m,
          FieldDoc{"least height of the LiDAR, from the places of the map (1 m above the floor)",
                   -5.0, 5.0});
    visit("highest_m", self.highest_m, FieldDoc{"likewise the greatest", -5.0, 50.0});
    visit("reach_m", self.reach_m,
          FieldDoc{"returns farther away are not searched with", 5.0, 100.0});
    visit("most_work", self.most_work,
          FieldDoc{"look-ups after which a search ends without an answer", 1e5, 1e12});
  }
};

}  // namespace holdfast::relocalization
