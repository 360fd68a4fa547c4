#pragma once

#include <string>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

/// A hole in a tunnel's wall.
struct TunnelRecess {
  double at = 0;               ///< where it begins, along the axis
  std::string side = "right";  ///< of the axis
  std::string kind = "door";
  bool has_at = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at, FieldDoc{"where it begins, along the axis", 0, 1e5}, &self.has_at);
    FieldDoc sides{"of the axis"};
    sides.choices = "right|left";
    visit("side", self.side, sides);
    FieldDoc kinds{"a door of metal, 12 cm deep, or an open niche, 35 cm"};
    kinds.choices = "door|niche";
    visit("kind", self.kind, kinds);
  }
};

/// A vaulted road tunnel with kerbs, 5.4 m high: straight, a bend to the left, straight. Its axis
/// begins at the origin, along x; before each portal lies an open cutting.
struct Tunnel {
  double length = 200;        ///< along the axis, in steps of 2.5 m
  double width = 9;           ///< between its walls
  double curve_begin = 70;    ///< along the axis
  double curve_radius = 350;  ///< of the axis
  double curve_length = 70;   ///< along the axis
  double cutting = 24;        ///< metres of open road before each portal
  std::vector<TunnelRecess> recesses;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("length", self.length, FieldDoc{"along its axis, in steps of 2.5 m", 5, 1e5});
    visit("width", self.width, FieldDoc{"between its walls", 3, 13.9});
    visit("curve_begin", self.curve_begin, FieldDoc{"of the bend, along the axis", 0, 1e5});
    visit("curve_radius", self.curve_radius, FieldDoc{"of the axis, to the left", 20, 1e6});
    visit("curve_length", self.curve_length, FieldDoc{"of the bend, along the axis", 0, 1e5});
    visit("cutting", self.cutting, FieldDoc{"open road before each portal", 6, 1000});
  }
  void add_to(WorldBuilder& build) const;
};

}  // namespace holdfast::simulation
