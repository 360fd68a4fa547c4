#pragma once

#include "simulation/files/solids.hpp"
#include "simulation/world/furniture.hpp"

/// What stands in worlds, as files hold it (simulation/world/furniture.hpp).
namespace holdfast::simulation {

/// What looks alike from all sides.
struct RoundPart {
  Eigen::Vector2d at{0, 0};
  bool has_at = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at", self.at, FieldDoc{"x y where it stands"}, &self.has_at);
  }
};

/// What has a front.
struct StandingPart : RoundPart {
  double yaw_deg = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    RoundPart::fields(self, visit);
    visit("yaw_deg", self.yaw_deg, FieldDoc{"turned about the vertical; its front faces +x"});
  }
  Placement place() const { return {at, yaw_deg * kRadPerDeg}; }
};

/// Things of one size.
template <void (*kAdd)(WorldBuilder&, const Placement&)>
struct PlainPart : StandingPart {
  void add_to(WorldBuilder& build) const { kAdd(build, place()); }
};

using DeskPart = PlainPart<add_desk>;
using ChairPart = PlainPart<add_chair>;
using PlainChairPart = PlainPart<add_plain_chair>;
using CarPart = PlainPart<add_car>;

struct PlantPart : RoundPart {
  void add_to(WorldBuilder& build) const { add_plant(build, at); }
};

/// Things of a length.
template <void (*kAdd)(WorldBuilder&, const Placement&, double)>
struct LongPart : StandingPart {
  double length = 2;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("length", self.length,
          FieldDoc{"along y before it is turned; of a pole its height", 0.1, 100});
  }
  void add_to(WorldBuilder& build) const { kAdd(build, place(), length); }
};

using TablePart = LongPart<add_table>;
using BenchPart = LongPart<add_bench>;
using PolePart = LongPart<add_pole>;

struct TreePart : RoundPart {
  double height = 6;
  int shape = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    RoundPart::fields(self, visit);
    visit("height", self.height, FieldDoc{"from the ground to the top", 0.5, 60});
    visit("shape", self.shape, FieldDoc{"another number, another crown", 0, 1000});
  }
  void add_to(WorldBuilder& build) const { add_tree(build, at, height, shape); }
};

struct PartitionPart : StandingPart {
  double length = 2, height = 1.6;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("length", self.length, FieldDoc{"along y before it is turned", 0.1, 50});
    visit("height", self.height, FieldDoc{"from the ground to the top", 0.1, 20});
  }
  void add_to(WorldBuilder& build) const { add_partition(build, place(), length, height); }
};

struct WallBoxPart : StandingPart {
  double bottom = 1;
  Eigen::Vector3d size{0.1, 1, 1};
  std::string material = "painted metal";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("bottom", self.bottom, FieldDoc{"height of its lower side"});
    visit("size", self.size, FieldDoc{"away from the wall, along it, and up", 0.001, 100});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    add_wall_box(build, place(), bottom, size, material_of(material));
  }
};

}  // namespace holdfast::simulation
