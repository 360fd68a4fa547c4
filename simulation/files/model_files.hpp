#pragma once

#include <filesystem>
#include <string>

#include "holdfast/core/result.hpp"
#include "simulation/files/solids.hpp"

/// Parts of a world that stand in files of their own. Paths count from the folder of the scenario
/// file, whose name `scenario` is.
namespace holdfast::simulation {

/// Where a model stands: turned about the vertical through the model's origin, then moved to `at`.
struct ModelPlace {
  std::string file;
  Eigen::Vector3d at{0, 0, 0};
  double yaw_deg = 0;
  bool has_file = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("file", self.file, FieldDoc{"its path from the folder of this file"}, &self.has_file);
    visit("at", self.at, FieldDoc{"x y z of the origin of the file"});
    visit("yaw_deg", self.yaw_deg, FieldDoc{"turned about the vertical through its origin"});
  }
  std::filesystem::path path(const std::string& scenario) const;
  Eigen::Isometry3d T_world_model() const;
};

/// Triangles of a .ply or .obj file.
struct MeshPart : ModelPlace {
  double scale = 1;
  std::string up = "z", sides = "both";
  std::string material = "concrete";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    ModelPlace::fields(self, visit);
    visit("scale", self.scale, FieldDoc{"metres for one unit of the file", 1e-6, 1e6});
    FieldDoc up{"axis of the file that points up"};
    up.choices = "z|y";
    visit("up", self.up, up);
    FieldDoc sides{"what a survey sees: the front is where corners run counter-clockwise"};
    sides.choices = "both|front|back";
    visit("sides", self.sides, sides);
    visit("material", self.material, material_doc());
  }
  Status add_to(WorldBuilder& build, const std::string& scenario) const;
};

/// Points of a .pcd or .ply file, as discs (simulation/clouds/cloud_discs.hpp).
struct CloudPart : ModelPlace {
  double spacing = 0.1;
  std::string material = "concrete", scattered = "foliage";

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    ModelPlace::fields(self, visit);
    visit("spacing", self.spacing,
          FieldDoc{"one point in each cube of this size is kept, metres", 1e-3, 10});
    visit("material", self.material, material_doc("what surfaces are made of"));
    visit("scattered", self.scattered,
          material_doc("what points are made of through which no surface goes"));
  }
  Status add_to(WorldBuilder& build, const std::string& scenario) const;
};

}  // namespace holdfast::simulation
