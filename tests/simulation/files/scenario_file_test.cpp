#include "simulation/files/scenario_file.hpp"

#include <gtest/gtest.h>

#include "simulation/files/solids.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

constexpr const char* kRoute = R"(
route:
  radius_m: 1.5
  corners: [[2, 2], [18, 2], [18, 8, 0, 0.5], [2, 8]]
)";

Scenario parsed(const std::string& text) {
  auto scenario = parse_scenario(text, "shed.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return scenario ? std::move(*scenario) : Scenario();
}

std::string complaint(const std::string& text) {
  const auto scenario = parse_scenario(text, "shed.yaml");
  EXPECT_FALSE(scenario) << text;
  return scenario ? "" : scenario.error().message;
}

void expect_complaint(const std::string& text, std::initializer_list<const char*> words) {
  const std::string message = complaint(text);
  for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(ScenarioFile, HoldsAWorldARouteAStyleAndPeople) {
  const Scenario shed = parsed(std::string(R"(
name: shed
world:
  - floor: {min: [0, 0], max: [20, 10], material: asphalt}
  - box: {center: [5, 5, 0.5], size: [1, 2, 1], yaw_deg: 90}
drive: {speed_m_s: 1.5, weave_m: 0}
people:
  - speed_m_s: 0.7
    route: {corners: [[4, 3], [16, 3], [16, 7]]}
)") + kRoute);
  EXPECT_EQ(shed.name, "shed");
  EXPECT_EQ(shed.world.triangles.size(), 2U + 12U);
  ASSERT_EQ(shed.world.materials.size(), 2U);
  EXPECT_STREQ(shed.world.materials[0].name, "asphalt");
  EXPECT_EQ(shed.style.speed_m_s, 1.5);
  EXPECT_EQ(shed.style.acceleration_m_s2, DriveStyle{}.acceleration_m_s2);
  ASSERT_EQ(shed.walkers.size(), 1U);
  EXPECT_EQ(shed.walkers[0].speed_m_s, 0.7);
  // A rectangle of 16 x 6 m: a corner of radius r saves (2 - pi/2) r.
  const double saved = (2 - 0.5 * std::numbers::pi) * (3 * 1.5 + 0.5);
  EXPECT_NEAR(shed.route.length(), 44 - saved, 1e-9);
}

TEST(ScenarioFile, HoldsATunnelWithRecesses) {
  const std::string tube = "world:\n  - tunnel: {length: 10, curve_begin: 10, curve_length: 0";
  const Scenario bare = parsed(tube + "}" + kRoute);
  const Scenario niche = parsed(tube + ", recesses: [{at: 3, kind: niche, side: left}]}" + kRoute);
  // A wall's face becomes one at each side and one above; below the kerb's height one more, and the
  // niche has five sides.
  EXPECT_EQ(niche.world.triangles.size(), bare.world.triangles.size() + 2U * (3 + 5));
  expect_complaint(tube + ", recesses: [{at: 3, kind: hole}]}" + kRoute,
                   {"shed.yaml:", "kind", "door|niche"});
  expect_complaint(tube + ", recesses: 3}" + kRoute, {"recesses", "a list"});
}

TEST(ScenarioFile, HoldsGroupsWhoComeToTheRobot) {
  const Scenario shed = parsed(std::string(R"(
world:
  - floor: {min: [0, 0], max: [20, 10]}
groups: {people: 4, near_m: 0.9}
)") + kRoute);
  EXPECT_EQ(shed.groups.people, 4);
  EXPECT_EQ(shed.groups.near_m, 0.9);
  EXPECT_EQ(shed.groups.lasts_s, GroupPlan{}.lasts_s);
  expect_complaint(std::string("world: []\ngroups: {people: 40}") + kRoute, {"people", "40"});
}

TEST(ScenarioFile, RepeatsPartsAStepOnEachTime) {
  const Scenario rows = parsed(std::string(R"(
world:
  - repeat:
      times: 3
      step: [4, 0, 0]
      parts:
        - repeat:
            times: 2
            step: [0, 5, 1]
            parts: [box: {center: [1, 1, 1], size: [1, 1, 1]}]
)") + kRoute);
  EXPECT_EQ(rows.world.triangles.size(), 6U * 12U);
  Eigen::Vector3f high = rows.world.vertices.front();
  for (const auto& v : rows.world.vertices) high = high.cwiseMax(v);
  EXPECT_TRUE(high.isApprox(Eigen::Vector3f(9.5F, 6.5F, 2.5F)));
}

TEST(ScenarioFile, NamesObjectsAndSpareOnes) {
  const Scenario things = parsed(std::string(R"(
world:
  - object: {name: sign, mounted: true, parts: [box: {center: [1, 1, 1], size: [1, 1, 1]}]}
  - crate: {at: [3, 3]}
  - spare: [crate: {at: [5, 5]}]
)") + kRoute);
  ASSERT_EQ(things.world.objects.size(), 3U);
  EXPECT_EQ(things.world.objects[0].name, "sign");
  EXPECT_TRUE(things.world.objects[0].mounted);
  EXPECT_FALSE(things.world.objects[1].spare);
  EXPECT_TRUE(things.world.objects[2].spare);
}

TEST(ScenarioFile, HasWallsWithOpenings) {
  const Scenario plain = parsed("world: [wall: {from: [0, 0], to: [9, 0]}]" + std::string(kRoute));
  const Scenario open = parsed(std::string(R"(
world:
  - wall:
      from: [0, 0]
      to: [9, 0]
      openings: [{start: 2, width: 1, through: true}, {start: 5, width: 1, back: glass}]
)") + kRoute);
  EXPECT_GT(open.world.triangles.size(), plain.world.triangles.size());
  EXPECT_STREQ(open.world.materials.back().name, "glass");
}

TEST(ScenarioFile, ARampRisesFromItsFootToItsHead) {
  const Scenario ramp =
      parsed("world: [ramp: {from: [0, 0, 0], to: [10, 0, 2], width: 4, thickness: 0}]" +
             std::string(kRoute));
  for (const auto& v : ramp.world.vertices) {
    EXPECT_NEAR(v.z(), 0.2F * v.x(), 1e-6);
    EXPECT_NEAR(std::abs(v.y()), 2, 1e-6);
  }
}

TEST(ScenarioFile, EveryMaterialThatIsNamedIsKnown) {
  std::string_view rest = kMaterialNames;
  while (!rest.empty()) {
    const std::string name(rest.substr(0, rest.find('|')));
    EXPECT_EQ(material_of(name).name, name);
    rest.remove_prefix(std::min(rest.size(), name.size() + 1));
  }
}

TEST(ScenarioFile, ErrorsSayWhereAndWhatIsExpected) {
  const std::string route = kRoute;
  expect_complaint("world: []", {"missing: 'route'"});
  expect_complaint("walls: []" + route, {"shed.yaml:1", "unknown key 'walls'", "world"});
  expect_complaint("world:\n  - bock: {size: [1, 1, 1]}" + route,
                   {"shed.yaml:2", "unknown part 'bock'", "box", "wall"});
  expect_complaint("world:\n  - box: {center: [1, 2], size: [1, 1, 1]}" + route,
                   {"shed.yaml:2", "center: expected 3 numbers, found a list of 2"});
  expect_complaint("world:\n  - box: {center: [1, 2, 3]}" + route, {"shed.yaml:2", "'size'"});
  expect_complaint("world:\n  - box: {centre: [1, 2, 3]}" + route,
                   {"unknown key 'centre'", "'center'"});
  expect_complaint("world:\n  - floor: {min: [0, 0], max: [1, 1], material: stone}" + route,
                   {"material: expected one of", "concrete"});
  expect_complaint("world:\n  - repeat: {times: 2, step: [1, 0, 0]}" + route,
                   {"list of parts, found nothing"});
  expect_complaint("world: 5" + route, {"expected a list of parts, found '5'"});
  expect_complaint("world: []\nroute: {corners: [[1, 1], [2, 2]]}", {"at least three"});
  expect_complaint("world: []\nroute:\n  corners: [[1, 1], [1, 1], [2, 2]]",
                   {"shed.yaml:3", "where the one before does"});
  expect_complaint("world: []\ndrive: {speed_m_s: -1}" + route, {"speed_m_s", "0.05 to 50"});
  expect_complaint("world: []\npeople:\n  - {rout: 1}" + route,
                   {"shed.yaml:3", "unknown key 'rout'", "route, speed_m_s"});
  expect_complaint("world:\n  - tree: {at: [1, 1], yaw_deg: 5}" + route, {"unknown key 'yaw_deg'"});
  expect_complaint("- a\n- b", {"expected a block of keys"});
  expect_complaint("world: [", {"shed.yaml:"});
}

TEST(ScenarioFile, ThatIsNotThereIsAnErrorWithItsName) {
  const auto none = make_scenario("no/such/shed.yaml");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("no/such/shed.yaml"), std::string::npos);
}

TEST(ScenarioFile, TheGarageHasTwoLevelsThatItsRouteJoins) {
  const Scenario garage = *make_scenario("garage");
  double low = 1e9, high = -1e9;
  for (double s = 0; s < garage.route.length(); s += 0.5) {
    const double z = garage.route.at(s).position.z();
    low = std::min(low, z);
    high = std::max(high, z);
    EXPECT_LT(std::abs(garage.route.at(s).slope), 0.14);
  }
  EXPECT_NEAR(low, 0, 1e-9);
  EXPECT_NEAR(high, 3.2, 1e-9);
}

}  // namespace
}  // namespace holdfast::simulation
