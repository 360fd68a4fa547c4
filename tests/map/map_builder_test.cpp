#include "holdfast/map/map_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

namespace holdfast::map {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using Eigen::Vector3d;

/// Ground and a wall of 80 x 40 m over several tiles, coarse so that a map is made in no time.
io::PointCloud wide_cloud() {
  RandomStream random(1, "wide");
  io::PointCloud cloud;
  add_patch({-40, -10, 0}, {80, 0, 0}, {0, 40, 0}, random, cloud.points, 0.4);
  add_patch({-40, 5, 0}, {80, 0, 0}, {0, 0, 6}, random, cloud.points, 0.4);
  return cloud;
}

MapSource source_of(io::PointCloud cloud) { return {std::move(cloud), std::nullopt, "cloud.pcd"}; }

/// Names and contents of all files below a folder.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    files[fs::relative(entry.path(), folder).string()] = text.str();
  }
  return files;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

std::vector<std::array<float, 3>> sorted(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::array<float, 3>> values;
  for (const auto& p : points) values.push_back({p.x(), p.y(), p.z()});
  std::sort(values.begin(), values.end());
  return values;
}

TEST(BuildMap, WritesTheSameBytesWithOneAndTwoThreads) {
  const BuiltMap one(wide_cloud(), 1);
  const BuiltMap two(wide_cloud(), 2);
  const auto files = contents(one.path());
  EXPECT_EQ(files, contents(two.path()));
  EXPECT_EQ(files.size(), 1 + 2 * one.info().tiles.size());
  EXPECT_GE(one.info().tiles.size(), 6U);
}

TEST(BuildMap, IdentityTellsMapsApart) {
  io::PointCloud moved = wide_cloud();
  moved.points[17].z() += 0.001F;
  const BuiltMap a(wide_cloud());
  const BuiltMap b(std::move(moved));
  EXPECT_NE(a.info().identity, b.info().identity);
}

TEST(BuildMap, ExportGivesBackThePointsThatWereImported) {
  const io::PointCloud cloud = wide_cloud();
  const BuiltMap built(cloud);
  const auto exported = PriorMap::read_points(built.path(), built.info());
  ASSERT_TRUE(exported) << exported.error().message;
  EXPECT_EQ(exported->origin, Vector3d::Zero());
  EXPECT_EQ(sorted(exported->points), sorted(cloud.points));
  EXPECT_EQ(built.info().points, cloud.points.size());
}

TEST(BuildMap, EdgesAreExportedToo) {
  io::PointCloud edges;
  for (int i = 0; i < 100; ++i) edges.points.push_back({0.5F, 0.5F, 0.05F * static_cast<float>(i)});
  const io::PointCloud planes = wide_cloud();
  const BuiltMap built(MapSource{planes, edges, "features"});
  const auto exported = PriorMap::read_points(built.path(), built.info());
  ASSERT_TRUE(exported);
  auto both = planes.points;
  both.insert(both.end(), edges.points.begin(), edges.points.end());
  EXPECT_EQ(sorted(exported->points), sorted(both));
}

TEST(BuildMap, ExportKeepsMillimetresOfAProjection) {
  io::PointCloud cloud = wide_cloud();
  cloud.origin = {456'789.125, 5'987'654.25, 312.5};
  // On a grid of 1/1024 m: a float holds it exactly within 8 km of the map's own origin.
  for (auto& p : cloud.points) p = (p * 1024).array().round() / 1024;
  const BuiltMap built(cloud);
  const auto exported = PriorMap::read_points(built.path(), built.info());
  ASSERT_TRUE(exported);
  std::vector<Eigen::Vector3f> seen_from_cloud;
  for (const auto& p : exported->points) {
    seen_from_cloud.push_back((p.cast<double>() + exported->origin - cloud.origin).cast<float>());
  }
  EXPECT_EQ(sorted(seen_from_cloud), sorted(cloud.points));
}

TEST(BuildMap, MapYamlIsReadBackAsItWasWritten) {
  const BuiltMap built(wide_cloud());
  const auto info = read_map_info(built.path());
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(format_map_info(*info), format_map_info(built.info()));
  EXPECT_EQ(info->identity, built.info().identity);
  EXPECT_EQ(info->source, "test");
  EXPECT_EQ(info->gravity_map, Vector3d(0, 0, -9.81));
  EXPECT_EQ(info->bounds_min, built.info().bounds_min);
  EXPECT_EQ(info->bounds_max, built.info().bounds_max);
}

TEST(BuildMap, ASourceOfAnyNameIsReadBack) {
  for (const char* name :
       {"", "a: b", "- [1, 2]", "\"quoted\" 'twice'", "über die Brücke #3.pcd"}) {
    const BuiltMap built(MapSource{wide_cloud(), std::nullopt, name});
    const auto info = read_map_info(built.path());
    ASSERT_TRUE(info) << name << ": " << info.error().message;
    EXPECT_EQ(info->source, name);
  }
}

TEST(BuildMap, ProgressCountsUpToTheNumberOfTiles) {
  const ScratchFolder folder;
  WorkerPool pool(2);
  std::vector<std::size_t> done;
  std::size_t all = 0;
  const auto built = build_map(source_of(wide_cloud()), folder.path() / "map", pool,
                               [&](std::size_t n, std::size_t total) {
                                 done.push_back(n);
                                 all = total;
                               });
  ASSERT_TRUE(built);
  EXPECT_EQ(all, built->tiles.size());
  ASSERT_EQ(done.size(), all);
  for (std::size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], i + 1);
}

/// Expects an error that contains `words` and leaves the folder empty.
void expect_refused(MapSource source, const std::string& words) {
  const ScratchFolder folder;
  WorkerPool pool(1);
  const auto built = build_map(std::move(source), folder.path() / "map", pool);
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().message.find(words), std::string::npos) << built.error().message;
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(BuildMap, TooFewPointsAreAnErrorThatLeavesNothing) {
  io::PointCloud cloud;
  cloud.points.assign(99, {1, 2, 3});
  expect_refused({cloud, std::nullopt, "few.pcd"}, "few.pcd: 99 usable points");
}

TEST(BuildMap, PointsThatMakeNoSurfaceAreAnErrorThatLeavesNothing) {
  io::PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    cloud.points.push_back({7.0F * static_cast<float>(i % 20), 7.0F * static_cast<float>(i / 20),
                            static_cast<float>(i % 7)});
  }
  expect_refused({cloud, std::nullopt, "stars.pcd"}, "stars.pcd: no plane or line");
}

TEST(BuildMap, AStrangersFolderIsNotTouched) {
  const ScratchFolder folder;
  std::ofstream(folder.path() / "thesis.tex") << "years of work";
  WorkerPool pool(1);
  const auto built = build_map(source_of(wide_cloud()), folder.path(), pool);
  ASSERT_FALSE(built);
  EXPECT_NE(built.error().message.find(folder.path().string()), std::string::npos);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"thesis.tex"});
}

TEST(BuildMap, AnOlderMapIsReplacedAndSurvivesAFailedImport) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "map";
  WorkerPool pool(1);
  ASSERT_TRUE(build_map(source_of(wide_cloud()), path, pool));
  const auto first = contents(path);
  io::PointCloud none;
  none.points.assign(10, {1, 2, 3});
  ASSERT_FALSE(build_map(source_of(none), path, pool));
  EXPECT_EQ(contents(path), first);
  io::PointCloud other = wide_cloud();
  for (auto& p : other.points) p.z() += 2;
  ASSERT_TRUE(build_map(source_of(other), path, pool));
  EXPECT_NE(contents(path), first);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"map"});
}

TEST(EstimateSpacing, IsTheDistanceBetweenNeighboursOnASurface) {
  for (const double spacing : {0.03, 0.06, 0.12}) {
    RandomStream random(2, "spacing");
    io::PointCloud cloud;
    add_patch({0.1, 0.1, 0.1}, {12, 0, 0}, {0, 12, 0}, random, cloud.points, spacing, 0.0);
    // Half a metre holds (0.5 / spacing)^2 points; the random place in each square and the rim
    // leave a few per cent.
    EXPECT_NEAR(estimate_spacing(cloud), spacing, 0.1 * spacing);
  }
}

TEST(BuildMap, NoiseIsThatOfTheWalls) {
  for (const double sigma : {0.005, 0.02}) {
    RandomStream random(3, "noise");
    io::PointCloud cloud;
    add_patch({0, 0, 0.1}, {10, 0, 0}, {0, 10, 0}, random, cloud.points, kSpacing, sigma);
    add_patch({0.1, 0, 0.1}, {0, 10, 0}, {0, 0, 4}, random, cloud.points, kSpacing, sigma);
    const BuiltMap built(std::move(cloud));
    // The lower quartile of 500 estimates: 0.1 sigma of one of them, which 15 points know to 20 %.
    EXPECT_NEAR(built.info().noise_m, sigma, 0.05 * sigma);
  }
}

}  // namespace
}  // namespace holdfast::map
