#include "simulation/aliases/aliases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "simulation/aliases/place_index.hpp"
#include "simulation/aliases/twin_check.hpp"
#include "simulation/world/world_builder.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTurn = std::numbers::pi;
// Noise of a range over the square root of the rays that see a wall: far below a millimetre; the
// world's vertices are floats of 20 m.
constexpr double kMetres = 2e-3;
constexpr double kRadians = 1e-3;

std::unique_ptr<Simulation> drive(Scenario scenario, double duration_s = 15) {
  SimulationOptions options;
  options.duration_s = duration_s;
  auto simulation = Simulation::create(std::move(scenario), options);
  EXPECT_TRUE(simulation) << simulation.error().message;
  return std::move(*simulation);
}

double seconds_of(const std::vector<AliasedStretch>& stretches) {
  double sum = 0;
  for (const AliasedStretch& stretch : stretches) sum += to_seconds(stretch.t1 - stretch.t0);
  return sum;
}

TEST(Aliases, OfAnEmptyRoomAreItsHalfTurns) {
  const auto simulation = drive(*make_scenario("box"));
  const auto stretches = find_aliases(*simulation, AliasModel{});
  const double duration = to_seconds(simulation->end_time() - simulation->start_time());
  EXPECT_NEAR(seconds_of(stretches), duration, 1e-6);
  ASSERT_FALSE(stretches.empty());
  for (const AliasedStretch& stretch : stretches) {
    ASSERT_EQ(stretch.poses.size(), 1U);
    const SE3 truth = simulation->truth_at(stretch.t0);
    const SE3& twin = stretch.poses[0];
    const Vector3d mirrored(12 - truth.translation.x(), 8 - truth.translation.y(),
                            truth.translation.z());
    EXPECT_LT((twin.translation - mirrored).norm(), kMetres);
    const Eigen::Quaterniond turned = Eigen::AngleAxisd(kTurn, Vector3d::UnitZ()) * truth.rotation;
    EXPECT_LT(twin.rotation.angularDistance(turned), kRadians);
  }
}

TEST(Aliases, AreGoneWhereOneCrateTellsTheHalvesApart) {
  Scenario scenario = *make_scenario("box");
  WorldBuilder build;
  build.box({{11, 4, 0.5}, {1, 1, 1}}, materials::kIdeal);
  const World crate = build.build();
  const auto first = static_cast<std::uint32_t>(scenario.world.vertices.size());
  scenario.world.vertices.insert(scenario.world.vertices.end(), crate.vertices.begin(),
                                 crate.vertices.end());
  for (const auto& t : crate.triangles) {
    scenario.world.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    scenario.world.material_of.push_back(0);
    scenario.world.object_of.push_back(0);
  }
  EXPECT_TRUE(find_aliases(*drive(std::move(scenario)), AliasModel{}).empty());
}

/// Two rooms of 8 x 6 m that are alike, `apart` metres from one to the other, each with a crate.
Scenario two_rooms(double apart) {
  WorldBuilder build;
  for (const double x : {0.0, apart}) {
    build.moved({x, 0, 0}, [&] {
      build.floor({0, 0}, {8, 6}, 0, materials::kIdeal);
      build.ceiling({0, 0}, {8, 6}, 3, materials::kIdeal);
      const Vector2d corners[] = {{0, 0}, {8, 0}, {8, 6}, {0, 6}};
      for (int i = 0; i < 4; ++i) {
        build.wall({corners[i], corners[(i + 1) % 4], 0, 3, materials::kIdeal, {}});
      }
      build.box({{1, 1.5, 0.6}, {0.8, 1.2, 1.2}}, materials::kIdeal);
    });
  }
  Scenario scenario;
  scenario.name = "two rooms";
  scenario.world = build.build();
  scenario.route = Route::closed({{2.5, 2}, {apart + 6, 2}, {apart + 6, 4.5}, {2.5, 4.5}}, 1);
  return scenario;
}

TEST(Aliases, OfTwoRoomsThatAreAlikeLeadFromOneToTheOther) {
  const auto simulation = drive(two_rooms(12), 40);
  const auto stretches = find_aliases(*simulation, AliasModel{});
  int inside = 0;
  for (const AliasedStretch& stretch : stretches) {
    const SE3 truth = simulation->truth_at(stretch.t0);
    const double x = truth.translation.x();
    if (x > 8 && x < 12) continue;  // between the rooms
    ++inside;
    ASSERT_EQ(stretch.poses.size(), 1U);
    const double way = x < 8 ? 12 : -12;
    EXPECT_LT((stretch.poses[0].translation - truth.translation - Vector3d(way, 0, 0)).norm(),
              kMetres);
    EXPECT_LT(stretch.poses[0].rotation.angularDistance(truth.rotation), kRadians);
  }
  EXPECT_GT(inside, 0);
  EXPECT_GT(seconds_of(stretches), 15);
}

TEST(Aliases, AreTheSameForAnyNumberOfThreads) {
  const auto lines = [](int threads) {
    SimulationOptions options;
    options.scenario = "box";
    options.duration_s = 5;
    options.threads = threads;
    std::string text;
    for (const auto& stretch : find_aliases(*testing::make(options), AliasModel{})) {
      text += alias_json(stretch) + "\n";
    }
    return text;
  };
  EXPECT_EQ(lines(1), lines(2));
}

TEST(AliasJson, HoldsTimesAndPoses) {
  const SE3 pose{Eigen::Quaterniond::Identity(), {1, 2, 3}};
  const auto json =
      nlohmann::json::parse(alias_json({from_seconds(1.5), from_seconds(2.5), {pose}}));
  EXPECT_EQ(json["t0"], 1.5);
  EXPECT_EQ(json["t1"], 2.5);
  ASSERT_EQ(json["poses"].size(), 1U);
  EXPECT_EQ(json["poses"][0], nlohmann::json({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
}

TEST(TwinCheck, ComesBackToThePlaceOfAnImage) {
  const Scenario office = *make_scenario("office");
  const RayCaster caster(office.world);
  const ImageRays rays = ImageRays::over(-0.26, 0.26, 16, 360, 100);
  const TwinCheck check(office.world, caster, rays, 0.02);
  const SE3 truth{Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Vector3d::UnitZ())),
                  office.route.at(5).position + Vector3d(0, 0, 0.6)};
  const RangeImage seen = render(caster, rays, truth);
  EXPECT_EQ(check.differing(seen, truth), 0U);
  SE3 start = truth;
  start.translation += Vector3d(0.25, -0.2, 0.05);
  start.rotation = start.rotation * Eigen::AngleAxisd(0.05, Vector3d::UnitZ());
  EXPECT_GT(check.differing(seen, start), check.explained_by_noise());
  const SE3 found = check.refined(seen, start);
  EXPECT_LT((found.translation - truth.translation).norm(), kMetres);
  EXPECT_LT(found.rotation.angularDistance(truth.rotation), kRadians);
}

TEST(PlaceIndex, FindsThePlaceAndTheTurn) {
  const Scenario office = *make_scenario("office");
  const RayCaster caster(office.world);
  const ImageRays rays = ImageRays::over(-0.26, 0.26, 16, 360, 100);
  std::vector<Vector3d> positions;
  for (double s = 0; s < office.route.length(); s += 1) {
    positions.emplace_back(office.route.at(s).position + Vector3d(0, 0, 0.6));
  }
  PlaceIndex index(rays);
  WorkerPool pool(1);
  index.add(caster, positions, pool);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(-0.7, Vector3d::UnitZ()));
  // Seen by one who is turned by -0.7: facing along x at the place, one has to turn by that much.
  const auto matches = index.similar(render(caster, rays, {turned, positions[3]}), 10, 5);
  ASSERT_EQ(matches.size(), 5U);
  EXPECT_EQ(matches[0].position, positions[3]);
  EXPECT_NEAR(std::remainder(matches[0].turn_rad + 0.7, 2 * kTurn), 0, kTurn / 360);
}

}  // namespace
}  // namespace holdfast::simulation
