#include "holdfast/io/atomic_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct AtomicOutput : ::testing::Test {
  TemporaryFolder folder;

  AtomicFolder started(const fs::path& path) {
    auto out = AtomicFolder::create(path, "marker.json");
    EXPECT_TRUE(out) << out.error().message;
    return std::move(out).value();
  }
  static void fill(const AtomicFolder& out, std::string_view content) {
    std::ofstream(out.staging() / "marker.json") << content;
  }
};

TEST_F(AtomicOutput, AFileHasItsContentAndNothingElseIsLeft) {
  const auto path = folder / "a.txt";
  ASSERT_TRUE(write_file_atomically(path, std::string_view("one\0two", 7)));
  EXPECT_EQ(read_bytes(path), std::string("one\0two", 7));
  ASSERT_TRUE(write_file_atomically(path, ""));
  EXPECT_EQ(read_bytes(path), "");
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST_F(AtomicOutput, AFileThatCannotBeWrittenNamesItsPathAndLeavesNothing) {
  const auto missing = write_file_atomically(folder / "no/such/a.txt", "x");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("no/such/a.txt: cannot be written"));
  fs::create_directory(folder / "taken");
  const auto taken = write_file_atomically(folder / "taken", "x");
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, HasSubstr("taken: is a folder"));
  EXPECT_THAT(folder.names(), ElementsAre("taken"));
}

TEST_F(AtomicOutput, AFolderAppearsWithCommitOnly) {
  {
    auto out = started(folder / "run");
    fill(out, "new");
    EXPECT_EQ(out.staging().parent_path(), folder.path());  // one file system: rename is atomic
    EXPECT_FALSE(fs::exists(folder / "run"));
    ASSERT_TRUE(out.commit());
  }
  EXPECT_EQ(read_bytes(folder / "run/marker.json"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("run"));
}

TEST_F(AtomicOutput, AFolderWithoutCommitLeavesNothing) {
  { fill(started(folder / "run"), "lost"); }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST_F(AtomicOutput, AMovedFolderIsRemovedOnceByItsLastOwner) {
  {
    std::optional<AtomicFolder> first(started(folder / "run/"));
    AtomicFolder second(std::move(*first));
    first.reset();
    EXPECT_TRUE(fs::exists(second.staging()));
    fill(second, "x");
    ASSERT_TRUE(second.commit());
  }
  EXPECT_THAT(folder.names(), ElementsAre("run"));
}

TEST_F(AtomicOutput, TwoFoldersForOneNameDoNotShareTheirStaging) {
  auto first = started(folder / "run");
  auto second = started(folder / "run");
  EXPECT_NE(first.staging(), second.staging());
  fill(first, "first");
  fill(second, "second");
  ASSERT_TRUE(first.commit());
  ASSERT_TRUE(second.commit());
  EXPECT_EQ(read_bytes(folder / "run/marker.json"), "second");
}

TEST_F(AtomicOutput, AnEmptyFolderOrOneOfOursIsReplacedWithAllItHolds) {
  fs::create_directory(folder / "run");
  auto first = started(folder / "run");
  fill(first, "first");
  std::ofstream(first.staging() / "old.txt") << "old";
  ASSERT_TRUE(first.commit());
  auto second = started(folder / "run");
  fill(second, "second");
  ASSERT_TRUE(second.commit());
  EXPECT_EQ(read_bytes(folder / "run/marker.json"), "second");
  EXPECT_FALSE(fs::exists(folder / "run/old.txt"));
  EXPECT_THAT(folder.names(), ElementsAre("run"));
}

TEST_F(AtomicOutput, AStrangersFolderIsNeverTouched) {
  folder.put("home/thesis.tex", "precious");
  const auto at_start = AtomicFolder::create(folder / "home", "marker.json");
  ASSERT_FALSE(at_start);
  EXPECT_THAT(at_start.error().message, HasSubstr("home: is a folder with other content"));
  EXPECT_THAT(at_start.error().message, HasSubstr("marker.json"));

  auto out = started(folder / "late");
  fill(out, "x");
  folder.put("late/thesis.tex", "came in between");
  EXPECT_FALSE(out.commit());
  EXPECT_EQ(read_bytes(folder / "home/thesis.tex"), "precious");
  EXPECT_EQ(read_bytes(folder / "late/thesis.tex"), "came in between");
}

TEST_F(AtomicOutput, AFileInTheWayOfAFolderIsAnError) {
  const auto path = folder.put("run", "a file");
  const auto out = AtomicFolder::create(path, "marker.json");
  ASSERT_FALSE(out);
  EXPECT_THAT(out.error().message, HasSubstr("run: exists and is not a folder"));
  const auto below = AtomicFolder::create(path / "run", "marker.json");
  ASSERT_FALSE(below);
  EXPECT_EQ(read_bytes(path), "a file");
}

TEST_F(AtomicOutput, AFolderWithoutItsMarkerIsNotCommitted) {
  auto out = started(folder / "run");
  const auto status = out.commit();
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("marker.json was not written"));
  EXPECT_FALSE(fs::exists(folder / "run"));
}

TEST_F(AtomicOutput, MissingParentsOfAFolderAreMade) {
  auto out = started(folder / "a/b/run");
  fill(out, "x");
  ASSERT_TRUE(out.commit());
  EXPECT_TRUE(fs::exists(folder / "a/b/run/marker.json"));
}

}  // namespace
}  // namespace holdfast::io::testing
