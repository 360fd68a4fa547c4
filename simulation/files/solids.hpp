#pragma once

#include <numbers>
#include <string>

#include "holdfast/core/fields.hpp"
#include "simulation/world/world_builder.hpp"

/// Parts of a world as files hold them: a list of fields, and what they build.
namespace holdfast::simulation {

inline constexpr std::string_view kMaterialNames =
    "ideal|plaster|concrete|brick|asphalt|grass|foliage|linoleum|carpet|ceiling tile|wood|fabric|"
    "cardboard|painted metal|aluminium|clothing|glass|polished stone|clear glass|mirror stone|"
    "mirror steel";

/// One of kMaterialNames.
Material material_of(const std::string& name);

/// Of a key that names a material.
inline FieldDoc material_doc(std::string_view text = "what its surface is made of") {
  FieldDoc doc{text};
  doc.choices = kMaterialNames;
  return doc;
}

inline constexpr double kRadPerDeg = std::numbers::pi / 180;

struct FloorPart {
  Eigen::Vector2d min{0, 0}, max{1, 1};
  double z = 0;
  std::string material = "concrete";
  bool has_min = false, has_max = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min", self.min, FieldDoc{"corner x y"}, &self.has_min);
    visit("max", self.max, FieldDoc{"opposite corner"}, &self.has_max);
    visit("z", self.z, FieldDoc{"height"});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const { build.floor(min, max, z, material_of(material)); }
};

/// Seen from below.
struct CeilingPart : FloorPart {
  void add_to(WorldBuilder& build) const { build.ceiling(min, max, z, material_of(material)); }
};

struct BoxPart {
  Eigen::Vector3d center{0, 0, 0}, size{1, 1, 1};
  double yaw_deg = 0;
  std::string material = "concrete";
  bool has_center = false, has_size = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("center", self.center, FieldDoc{"x y z"}, &self.has_center);
    visit("size", self.size, FieldDoc{"along x, y and z before it is turned", 1e-3, 1e4},
          &self.has_size);
    visit("yaw_deg", self.yaw_deg, FieldDoc{"turned about the vertical"});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    build.box({center, size, yaw_deg * kRadPerDeg}, material_of(material));
  }
};

/// A flat piece of ground that rises from one side to the other, seen from both sides.
struct RampPart {
  Eigen::Vector3d from{0, 0, 0}, to{1, 0, 0};
  double width = 3;
  double thickness = 0.2;
  std::string material = "concrete";
  bool has_from = false, has_to = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("from", self.from, FieldDoc{"middle of its foot, x y z"}, &self.has_from);
    visit("to", self.to, FieldDoc{"middle of its head"}, &self.has_to);
    visit("width", self.width, FieldDoc{"across", 0.01, 1e4});
    visit("thickness", self.thickness, FieldDoc{"down to its underside", 0, 100});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const;
};

struct CylinderPart {
  Eigen::Vector3d base{0, 0, 0};
  double radius = 0.2, height = 3;
  int segments = 48;
  std::string material = "concrete";
  bool has_base = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("base", self.base, FieldDoc{"middle of its foot, x y z"}, &self.has_base);
    visit("radius", self.radius, FieldDoc{"of its mantle", 1e-3, 1e4});
    visit("height", self.height, FieldDoc{"from its foot up", 1e-3, 1e4});
    visit("segments", self.segments, FieldDoc{"flat pieces of its mantle", 3, 1000});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    build.cylinder(base, radius, height, material_of(material), segments);
  }
};

/// A hole in a wall; one of the blocks in a wall's `openings`.
struct OpeningPart {
  WallOpening opening;
  std::string back = "wood";
  bool has_start = false, has_width = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    WallOpening& o = self.opening;
    visit("start", o.start, FieldDoc{"along the wall", 0, 1e4}, &self.has_start);
    visit("width", o.width, FieldDoc{"likewise", 0.01, 1e4}, &self.has_width);
    visit("bottom", o.bottom, FieldDoc{"height in the map"});
    visit("top", o.top, FieldDoc{"likewise"});
    visit("depth", o.depth, FieldDoc{"how far its sides reach behind the wall's face", 0, 100});
    visit("through", o.through, FieldDoc{"no back: one looks, and may drive, through"});
    visit("back", self.back, material_doc("what its back is made of"));
  }
};

/// An upright wall, seen from its left.
struct WallPart {
  WallPlan plan{{0, 0}, {1, 0}, 0, 3, {}, {}};
  std::string material = "plaster";
  bool has_from = false, has_to = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("from", self.plan.from, FieldDoc{"x y of its foot; it is seen from the left of the way"},
          &self.has_from);
    visit("to", self.plan.to, FieldDoc{"where it ends"}, &self.has_to);
    visit("bottom", self.plan.bottom, FieldDoc{"height"});
    visit("top", self.plan.top, FieldDoc{"height"});
    visit("material", self.material, material_doc());
  }
  void add_to(WorldBuilder& build) const {
    WallPlan whole = plan;
    whole.material = material_of(material);
    build.wall(whole);
  }
};

}  // namespace holdfast::simulation
