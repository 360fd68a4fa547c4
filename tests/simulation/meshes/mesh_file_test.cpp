#include "simulation/meshes/mesh_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "simulation/files/scenario_file.hpp"
#include "simulation/truth/true_edges.hpp"
#include "simulation/world/ray_caster.hpp"
#include "tests/simulation/world_files.hpp"

namespace holdfast::simulation {
namespace {

using testing::casts_down;
using testing::WorldFolder;

// A unit cube, as six polygons with four corners each.
constexpr const char* kCubeObj = R"(v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

constexpr const char* kSquarePly = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 1
2 0 1
2 2 1
0 2 1
4 0 1 2 3
)";

std::string complaint(const std::filesystem::path& path) {
  const auto mesh = read_mesh(path);
  EXPECT_FALSE(mesh) << path;
  return mesh ? "" : mesh.error().message;
}

TEST(MeshFile, CutsPolygonsOfAnObjIntoTriangles) {
  const WorldFolder folder;
  const auto mesh = read_mesh(folder.write("cube.obj", kCubeObj));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 12U);
}

TEST(MeshFile, TellsAPlyWithFacesFromACloud) {
  const WorldFolder folder;
  const auto square = folder.write("square.ply", kSquarePly);
  EXPECT_TRUE(has_faces(square));
  EXPECT_EQ(read_mesh(square)->triangles.size(), 2U);
  const auto points = folder.write("points.ply",
                                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                   "property float y\nproperty float z\nend_header\n1 2 3\n");
  EXPECT_FALSE(has_faces(points));
  EXPECT_NE(complaint(points).find("expected faces, found none"), std::string::npos);
}

TEST(MeshFile, ErrorsNameTheFileAndWhatWasExpected) {
  const WorldFolder folder;
  const auto expect = [](const std::filesystem::path& path, const char* words) {
    const std::string message = complaint(path);
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  expect(folder.path() / "none.obj", "no such file");
  expect(folder.write("cube.stl", "solid"), "found '.stl'");
  expect(folder.write("points.obj", "v 0 0 0\nv 1 0 0\n"), "expected");
  expect(folder.write("far.obj", "v 0 0 0\nv 50000 0 0\nv 0 1 0\nf 1 2 3\n"), "within 10 km");
  expect(folder.write("nan.ply",
                      [] {
                        std::string text = kSquarePly;
                        return text.replace(text.find("2 2 1"), 5, "nan 2 1");
                      }()),
         "expected");
  expect(folder.write("cut.ply", std::string(kSquarePly).substr(0, 175)), "expected");
  expect(folder.write("noise.ply", "ply\nelement face 7\n\x01\x02\x03"), "expected");
}

TEST(MeshPart, StandsWhereTheScenarioSaysAndIsLookedUpBesideIt) {
  const WorldFolder folder;
  folder.write("cube.obj", kCubeObj);
  const auto file = folder.scenario(
      "  - mesh: {file: cube.obj, at: [10, 5, 2], yaw_deg: 90, scale: 3, material: wood}");
  const auto scenario = read_scenario_file(file);
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_STREQ(scenario->world.materials[0].name, "wood");
  // Turned by 90 degrees about its corner: x 7 to 10, y 5 to 8, top at 5.
  const RayCaster caster(scenario->world);
  EXPECT_NEAR(casts_down(caster, {7.01, 7.99, 20}), 15, 1e-5);
  EXPECT_NEAR(casts_down(caster, {9.99, 5.01, 20}), 15, 1e-5);
  EXPECT_TRUE(std::isinf(casts_down(caster, {10.01, 6, 20})));
  EXPECT_TRUE(std::isinf(casts_down(caster, {6.99, 6, 20})));
  double edges = 0;  // faces are there from both sides, the edges once
  for (const Segment& edge : true_edges(scenario->world)) edges += (edge.b - edge.a).norm();
  EXPECT_NEAR(edges, 12 * 3, 1e-4);
}

TEST(MeshPart, TurnsAFileWhoseYPointsUp) {
  const WorldFolder folder;
  folder.write("flat.obj", "v 0 7 0\nv 4 7 0\nv 4 7 -4\nv 0 7 -4\nf 1 2 3 4\n");
  const auto scenario =
      read_scenario_file(folder.scenario("  - mesh: {file: flat.obj, up: y, sides: front}"));
  ASSERT_TRUE(scenario) << scenario.error().message;
  EXPECT_EQ(scenario->world.triangles.size(), 2U);
  EXPECT_NEAR(casts_down(RayCaster(scenario->world), {1, 1, 20}), 13, 1e-5);
}

TEST(MeshPart, ErrorsNameScenarioLineAndFile) {
  const WorldFolder folder;
  const auto scenario = read_scenario_file(folder.scenario("  - mesh: {file: none.obj}"));
  ASSERT_FALSE(scenario);
  for (const char* words : {"world.yaml:3", "none.obj", "no such file"}) {
    EXPECT_NE(scenario.error().message.find(words), std::string::npos) << scenario.error().message;
  }
}

}  // namespace
}  // namespace holdfast::simulation
