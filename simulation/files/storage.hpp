#pragma once

#include "simulation/files/furnishings.hpp"

/// What things are kept in, as files hold it.
namespace holdfast::simulation {

struct ShelfPart : StandingPart {
  double width = 1, height = 2;
  int variant = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("width", self.width, FieldDoc{"along y before it is turned", 0.1, 50});
    visit("height", self.height, FieldDoc{"from the ground to the top", 0.1, 20});
    visit("variant", self.variant, FieldDoc{"another number, other folders", 0, 1000});
  }
  void add_to(WorldBuilder& build) const {
    add_shelf(build, place(), width, height, static_cast<unsigned>(variant));
  }
};

struct CabinetPart : StandingPart {
  double width = 1, height = 2;
  std::string material = "wood";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("width", self.width, FieldDoc{"along y before it is turned", 0.1, 50});
    visit("height", self.height, FieldDoc{"from the ground to the top", 0.1, 20});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    add_cabinet(build, place(), width, height, material_of(material));
  }
};

struct CratePart : StandingPart {
  Eigen::Vector3d size{1, 1, 1};
  std::string material = "cardboard";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("size", self.size, FieldDoc{"along x, y and z before it is turned", 0.01, 100});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const { add_crate(build, place(), size, material_of(material)); }
};

struct RackPart : StandingPart {
  RackPlan plan;
  int variant = 0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    StandingPart::fields(self, visit);
    visit("bays", self.plan.bays, FieldDoc{"places side by side", 1, 1000});
    visit("bay", self.plan.bay, FieldDoc{"width of each", 0.3, 20});
    visit("levels", self.plan.levels, FieldDoc{"one above the other", 1, 50});
    visit("level_height", self.plan.level_height, FieldDoc{"of each", 0.2, 20});
    visit("variant", self.variant, FieldDoc{"another number, other loads", 0, 1000});
  }
  void add_to(WorldBuilder& build) const {
    RackPlan loaded = plan;
    loaded.variant = static_cast<unsigned>(variant);
    add_rack(build, place(), loaded);
  }
};

}  // namespace holdfast::simulation
