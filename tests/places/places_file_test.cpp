#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/places/placed_map.hpp"

/// places.bin: the same for any number of threads, missing, damaged.
namespace holdfast::places {
namespace {

using namespace testing;
using ::testing::HasSubstr;

io::PointCloud hall() { return room({-20, -4, 0}, {40, 20, 4}); }

TEST(PlacesFile, IsTheSameForAnyNumberOfThreads) {
  const std::string one = PlacedMap(hall(), 1).bytes();
  EXPECT_GT(one.size(), 50 * sizeof(Place)) << "over several tiles";
  EXPECT_EQ(PlacedMap(hall(), 2).bytes(), one);
  EXPECT_EQ(PlacedMap(hall(), 5).bytes(), one);
}

struct DamagedPlaces : ::testing::Test {
  PlacedMap map{room({0, 0, 0}, {10, 8, 3})};

  std::string failure() const {
    const auto places = Places::open(map.path());
    return places ? "" : places.error().message;
  }
  std::string verification() const {
    const auto info = map::read_map_info(map.path());
    if (!info) return info.error().message;
    const auto status = map::PriorMap::verify(map.path(), *info);
    return status ? "" : status.error().message;
  }
  void write(const std::string& content) const {
    std::ofstream(map.file(), std::ios::binary) << content;
  }
  void expect_named(const char* words) const {
    for (const std::string& message : {failure(), verification()}) {
      EXPECT_THAT(message, HasSubstr(map.file().string()));
      EXPECT_THAT(message, HasSubstr(words));
    }
  }
};

TEST_F(DamagedPlaces, AnUndamagedFileIsRead) {
  EXPECT_EQ(failure(), "");
  EXPECT_EQ(verification(), "");
}

TEST_F(DamagedPlaces, AFlippedBitNamesTheFile) {
  const std::string whole = map.bytes();
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{5}, whole.size() / 2, whole.size() - 1}) {
    std::string content = whole;
    content[at] = static_cast<char>(content[at] ^ 4);
    write(content);
    expect_named("checksum");
  }
}

TEST_F(DamagedPlaces, ACutFileNamesItself) {
  const std::string whole = map.bytes();
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{0}}) {
    write(whole.substr(0, size));
    expect_named("map.yaml says");
  }
}

TEST_F(DamagedPlaces, AMissingFileNamesItself) {
  std::filesystem::remove(map.file());
  expect_named("cannot open");
}

TEST(MapWithoutPlaces, OpensAndHasNone) {
  const map::testing::BuiltMap map(room({0, 0, 0}, {10, 8, 3}));
  const auto places = Places::open(map.path());
  ASSERT_TRUE(places) << places.error().message;
  EXPECT_TRUE(places->all().empty());
  EXPECT_EQ(places->nearest({5, 4, 1}, 100), nullptr);
}

TEST(MapWithPlaces, HasTheSameTilesAndIdentityAsOneWithout) {
  const PlacedMap with(room({0, 0, 0}, {10, 8, 3}));
  const map::testing::BuiltMap without(room({0, 0, 0}, {10, 8, 3}));
  EXPECT_EQ(map::read_map_info(with.path())->identity, without.info().identity);
}

}  // namespace
}  // namespace holdfast::places
