#pragma once

#include "holdfast/core/fields.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

/// A block-shaped house of brick with two rows of windows on all sides, seen from outside.
struct PlainHouse {
  Eigen::Vector2d min{0, 0};
  Eigen::Vector2d max{10, 10};
  double height = 9;         ///< from the ground to the roof
  double window_step = 3.1;  ///< metres from window to window on the first side
  bool has_min = false, has_max = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min", self.min, FieldDoc{"corner x y"}, &self.has_min);
    visit("max", self.max, FieldDoc{"opposite corner"}, &self.has_max);
    visit("height", self.height, FieldDoc{"from the ground to the roof", 6, 300});
    visit("window_step", self.window_step,
          FieldDoc{"from window to window; a little more on each further side", 1.5, 100});
  }
  void add_to(WorldBuilder& build) const;
};

}  // namespace holdfast::simulation
