#pragma once

#include "simulation/buildings/house.hpp"
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

struct HousePart {
  HousePlan plan;
  int variant = 0;
  std::string material = "brick";
  bool has_min = false, has_max = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    HousePlan& p = self.plan;
    visit("min", p.min, FieldDoc{"corner x y"}, &self.has_min);
    visit("max", p.max, FieldDoc{"opposite corner"}, &self.has_max);
    visit("ground", p.ground, FieldDoc{"height of its foot"});
    visit("height", p.height, FieldDoc{"from its foot to the roof", 1, 300});
    visit("storey", p.storey, FieldDoc{"height of each row of windows", 2.5, 20});
    visit("window_step", p.window_step, FieldDoc{"from window to window, about", 2.2, 100});
    visit("window_depth", p.window_depth, FieldDoc{"of their glass behind the wall", 0, 2});
    visit("pillars", p.pillars, FieldDoc{"on each facade", 0, 1000});
    visit("detailed_storeys", p.detailed_storeys, FieldDoc{"plain above these", 0, 100});
    visit("variant", self.variant, FieldDoc{"another number, another house", 0, 1000000});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    HousePlan whole = plan;
    whole.variant = static_cast<unsigned>(variant);
    whole.material = material_of(material);
    add_house(build, whole);
  }
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
