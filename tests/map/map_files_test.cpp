#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

/// Maps that are missing, damaged or made by another version.
namespace holdfast::map {
namespace {

namespace fs = std::filesystem;
using namespace testing;
using ::testing::HasSubstr;

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

io::PointCloud one_floor() {
  RandomStream random(1, "floor");
  io::PointCloud cloud;
  add_patch({2, 2, 0}, {20, 0, 0}, {0, 20, 0}, random, cloud.points, 0.3);
  return cloud;
}

struct MapFiles : ::testing::Test {
  BuiltMap built{one_floor()};
  fs::path yaml = built.path() / "map.yaml";
  fs::path tile = built.path() / (built.info().tiles.at(0).stem() + ".tile");
  fs::path points = built.path() / (built.info().tiles.at(0).stem() + ".points");

  /// What opening and focusing says; empty if it worked.
  std::string failure() const {
    auto map = PriorMap::open(built.path());
    if (!map) return map.error().message;
    const auto focused = map->focus({10, 10, 0}, 50.0);
    return focused ? "" : focused.error().message;
  }
  std::string verification() const {
    const auto status = PriorMap::verify(built.path(), built.info());
    return status ? "" : status.error().message;
  }
  std::string export_failure() const {
    const auto cloud = PriorMap::read_points(built.path(), built.info());
    return cloud ? "" : cloud.error().message;
  }
  void replace_in_yaml(const std::string& from, const std::string& to) const {
    std::string text = read(yaml);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(yaml, text.replace(at, from.size(), to));
  }
  static void flip(const fs::path& path, std::size_t at) {
    std::string content = read(path);
    ASSERT_LT(at, content.size());
    content[at] = static_cast<char>(content[at] ^ 0x10);
    write(path, content);
  }
};

TEST_F(MapFiles, AnUndamagedMapOpensAndVerifies) {
  EXPECT_EQ(failure(), "");
  EXPECT_EQ(verification(), "");
  EXPECT_EQ(export_failure(), "");
}

TEST_F(MapFiles, AFolderWithoutMapYamlIsNoMap) {
  fs::remove(yaml);
  EXPECT_THAT(failure(), HasSubstr(built.path().string()));
  EXPECT_THAT(failure(), HasSubstr("no map.yaml"));
  EXPECT_THAT(failure(), HasSubstr("holdfast map import"));
}

TEST_F(MapFiles, ANewerFormatSaysWhichVersionIsRead) {
  replace_in_yaml("format_version: 2", "format_version: 7");
  EXPECT_THAT(failure(), HasSubstr(yaml.string()));
  EXPECT_THAT(failure(), HasSubstr("format_version 7"));
  EXPECT_THAT(failure(), HasSubstr("reads 2"));
}

TEST_F(MapFiles, WhatIsNotYamlNamesTheFile) {
  write(yaml, "format_version: [1\n  - {");
  EXPECT_THAT(failure(), HasSubstr(yaml.string()));
  write(yaml, "");
  EXPECT_THAT(failure(), HasSubstr(yaml.string()));
  write(yaml, std::string("\0\x01\xff\xfe", 4));
  EXPECT_THAT(failure(), HasSubstr(yaml.string()));
}

TEST_F(MapFiles, EveryMissingKeyIsAnErrorThatNamesTheFile) {
  const std::string whole = read(yaml);
  for (const char* key :
       {"format_version", "identity", "source", "origin_m", "bounds_m", "gravity_map_m_s2",
        "points", "spacing_m", "noise_m", "levels", "tiles"}) {
    std::string text = whole;
    auto at = text.find(key);  // at the start of a line
    while (at != 0 && at != std::string::npos && text[at - 1] != '\n') at = text.find(key, at + 1);
    ASSERT_NE(at, std::string::npos) << key;
    write(yaml, text.replace(at, std::strlen(key), "other_key"));
    EXPECT_THAT(failure(), HasSubstr(built.path().string())) << "without " << key;
  }
}

TEST_F(MapFiles, DamageOfMapYamlIsAnErrorOrHarmlessButNeverACrash) {
  const std::string whole = read(yaml);
  RandomStream random(1, "damage");
  for (int k = 0; k < 500; ++k) {
    std::string text = whole;
    for (int n = 0; n < 1 + k % 3; ++n) {
      text[random.below(text.size())] = static_cast<char>(32 + random.below(95));
    }
    write(yaml, text);
    (void)failure();
  }
  for (std::size_t size = 0; size < whole.size(); size += 11) {
    write(yaml, whole.substr(0, size));
    (void)failure();
  }
}

TEST_F(MapFiles, ATileFarAwayIsAnErrorAndTakesNoMemory) {
  std::string text = read(yaml);
  const auto at = text.rfind("  - 0 0 ");
  ASSERT_NE(at, std::string::npos);
  write(yaml, text + "  - 2000000000 -2000000000 " + text.substr(at + 8));
  EXPECT_THAT(failure(), HasSubstr(built.path().string()));
}

TEST_F(MapFiles, AMissingTileNamesItsFile) {
  fs::remove(tile);
  EXPECT_THAT(failure(), HasSubstr(tile.string()));
  EXPECT_THAT(verification(), HasSubstr(tile.string()));
}

TEST_F(MapFiles, AFocusThatFailedFailsAgain) {
  fs::remove(tile);
  auto map = PriorMap::open(built.path());
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->focus({10, 10, 0}, 50.0));
  EXPECT_FALSE(map->focus({10, 10, 0}, 50.0)) << "the tile is still not there";
}

TEST_F(MapFiles, ATruncatedTileNamesItsFileWhateverIsLeft) {
  const std::string whole = read(tile);
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, sizeof(TileHeader),
                                 sizeof(TileHeader) - 1, std::size_t{1}, std::size_t{0}}) {
    write(tile, whole.substr(0, size));
    const auto opened = Tile::open(tile);
    ASSERT_FALSE(opened) << size;
    EXPECT_THAT(opened.error().message, HasSubstr(tile.string()));
    EXPECT_THAT(failure(), HasSubstr(tile.string()));
    EXPECT_THAT(verification(), HasSubstr(tile.string()));
  }
}

TEST_F(MapFiles, AFlippedBitInATileNamesItsFile) {
  const std::string whole = read(tile);
  for (const std::size_t at : {sizeof(TileHeader), whole.size() / 2, whole.size() - 1}) {
    write(tile, whole);
    flip(tile, at);
    EXPECT_THAT(failure(), HasSubstr(tile.string()));
    EXPECT_THAT(failure(), HasSubstr("checksum"));
    EXPECT_THAT(verification(), HasSubstr(tile.string()));
  }
}

TEST_F(MapFiles, AFlippedBitInAnyByteOfTheHeaderIsAnErrorOfTheMap) {
  for (std::size_t at = 0; at < sizeof(TileHeader); ++at) {
    flip(tile, at);
    EXPECT_THAT(failure(), HasSubstr(tile.string())) << "byte " << at;
    flip(tile, at);
  }
  EXPECT_EQ(failure(), "");
}

TEST_F(MapFiles, ATileOfAnotherVersionOrKindIsToldApart) {
  const std::string whole = read(tile);
  std::string other = whole;
  other[0] = 'X';
  write(tile, other);
  EXPECT_THAT(Tile::open(tile).error().message, HasSubstr("not a holdfast tile"));
  other = whole;
  other[4] = 9;
  write(tile, other);
  EXPECT_THAT(Tile::open(tile).error().message, HasSubstr("tile format 9, this program reads 2"));
}

TEST_F(MapFiles, ALevelThatPointsOutsideOfItsTileIsNotOpened) {
  const std::string whole = read(tile);
  const auto refuse = [&](auto change) {
    std::string content = whole;
    TileHeader header;
    std::memcpy(&header, content.data(), sizeof(header));
    change(header);
    std::memcpy(content.data(), &header, sizeof(header));
    write(tile, content);
    const auto opened = Tile::open(tile);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, HasSubstr(tile.string()));
  };
  refuse([](TileHeader& h) { h.levels[0].surfaces_offset = h.file_size; });
  refuse([](TileHeader& h) { h.levels[1].surface_count = 0xffffffff; });
  refuse([](TileHeader& h) { h.levels[2].block_count = 0xffffffff; });
  refuse([](TileHeader& h) { h.levels[0].index_offset = ~std::uint64_t{0} - 3; });
  refuse([](TileHeader& h) { h.levels[0].blocks_offset += 2; });
  refuse([](TileHeader& h) { h.levels[0].blocks_z = -1; });
  refuse([](TileHeader& h) { h.levels[0].blocks_xy = 1 << 30; });
  refuse([](TileHeader& h) { h.levels[0].cell_m = 0; });
  refuse([](TileHeader& h) { h.levels[0].cell_m = std::nanf(""); });
}

TEST_F(MapFiles, DamageOfThePointsIsFoundByExportAndVerifyOnly) {
  const std::string whole = read(points);
  flip(points, whole.size() / 2);
  EXPECT_EQ(failure(), "");  // localizing does not need them
  EXPECT_THAT(export_failure(), HasSubstr(points.string()));
  EXPECT_THAT(export_failure(), HasSubstr("checksum"));
  EXPECT_THAT(verification(), HasSubstr(points.string()));
  write(points, whole.substr(0, whole.size() - 1));
  EXPECT_THAT(export_failure(), HasSubstr(points.string()));
  EXPECT_THAT(export_failure(), HasSubstr("map.yaml says"));
  fs::remove(points);
  EXPECT_THAT(export_failure(), HasSubstr(points.string()));
}

TEST_F(MapFiles, AFolderThatIsNotThereNamesItself) {
  const auto map = PriorMap::open("/nowhere/map");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, HasSubstr("/nowhere/map"));
}

/// A road of 1.3 km.
struct LongMap : ::testing::Test {
  static io::PointCloud road() {
    RandomStream random(2, "road");
    io::PointCloud cloud;
    add_patch({-640, 14, 0}, {1280, 0, 0}, {0, 4, 0}, random, cloud.points, 0.5);
    return cloud;
  }
  BuiltMap built{road()};
};

TEST_F(LongMap, HasOnlyTheTilesNearTheRobotInMemory) {
  PriorMap map = built.open();
  constexpr double kRadius = 60.0;
  EXPECT_EQ(map.loaded_tiles(), 0U);
  EXPECT_EQ(built.info().tiles.size(), 40U);
  // Within the radius and one tile more are loaded, beyond twice the radius and one tile dropped.
  const std::size_t most =
      2 * static_cast<std::size_t>((2 * kRadius + kTileSizeM) / kTileSizeM) + 2;
  const auto least = static_cast<std::size_t>(kRadius / kTileSizeM);
  for (const double step : {1.0, -37.0}) {
    for (double x = step > 0 ? -640 : 640; std::abs(x) <= 640; x += step) {
      ASSERT_TRUE(map.focus({x, 16, 0}, kRadius));
      EXPECT_LE(map.loaded_tiles(), most);
      EXPECT_GE(map.loaded_tiles(), least);
      for (const double dx : {-kRadius, 0.0, kRadius}) {
        if (std::abs(x + dx) > 639) continue;
        const Eigen::Vector3d p(x + dx, 16, 0);
        ASSERT_NE(map.find(0, (p - map.anchor()).cast<float>()).surface, nullptr)
            << "robot at " << x << ", asked at " << p.x();
      }
    }
  }
}

TEST_F(LongMap, GivesTheSameAnswerWheneverAPlaceIsInReach) {
  PriorMap map = built.open();
  const Eigen::Vector3d p(5.3, 16.1, 0);
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const double x : {0.0, 300.0, -40.0, 40.0, -600.0, 5.0}) {
    ASSERT_TRUE(map.focus({x, 16, 0}, 60.0));
    const auto hit = map.find(0, (p - map.anchor()).cast<float>());
    EXPECT_EQ(hit.surface != nullptr, std::abs(x) < 100) << x;
    if (hit.surface == nullptr) continue;
    const Eigen::Vector3d center = map.anchor() + (hit.corner + hit.surface->center).cast<double>();
    if (x == 0.0) first = center;
    EXPECT_LT((center - first).norm(), 1e-5);
  }
}

TEST_F(LongMap, FarFromAllTilesNothingIsLoadedAndNothingFails) {
  PriorMap map = built.open();
  ASSERT_TRUE(map.focus({0, 16, 0}, 60.0));
  ASSERT_TRUE(map.focus({0, 50'000, 0}, 60.0));
  EXPECT_EQ(map.loaded_tiles(), 0U);
  EXPECT_EQ(map.find(0, Eigen::Vector3f(1, 1, 0)).surface, nullptr);
}

}  // namespace
}  // namespace holdfast::map
