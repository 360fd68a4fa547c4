#include "benchmarks/harness/result_log.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "benchmarks/harness/scratch_folder.hpp"

namespace holdfast::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

const Json kTerms = {{"duration_s", 20}};

struct ResultLogFile : ::testing::Test {
  ScratchFolder scratch = std::move(*ScratchFolder::create());
  std::filesystem::path file = scratch / "new/drives.jsonl";

  ResultLog open(const Json& terms = kTerms) {
    auto log = ResultLog::open(file, terms);
    EXPECT_TRUE(log) << log.error().message;
    return log ? std::move(*log) : ResultLog();
  }

  void append(const std::string& text) { std::ofstream(file, std::ios::app) << text; }
};

TEST_F(ResultLogFile, KnowsWhatARunBeforeHasFound) {
  ResultLog first = open();
  EXPECT_FALSE(first.find("hall 1"));
  ASSERT_TRUE(first.add("hall 1", {{"max_m", 0.25}}));
  ASSERT_TRUE(first.add("hall 2", {{"max_m", nullptr}}));
  const ResultLog second = open();
  ASSERT_TRUE(second.find("hall 1"));
  EXPECT_EQ((*second.find("hall 1"))["max_m"], 0.25);
  EXPECT_TRUE((*second.find("hall 2"))["max_m"].is_null());
  EXPECT_FALSE(second.find("hall 3"));
}

TEST_F(ResultLogFile, DropsTheHalfLineOfAStoppedRun) {
  ASSERT_TRUE(open().add("hall 1", {{"max_m", 0.25}}));
  append(R"({"key":"hall 2","res)");
  ResultLog log = open();
  EXPECT_FALSE(log.find("hall 2"));
  ASSERT_TRUE(log.add("hall 2", {{"max_m", 1}}));
  const ResultLog again = open();
  EXPECT_TRUE(again.find("hall 1"));
  EXPECT_TRUE(again.find("hall 2"));
}

TEST_F(ResultLogFile, RefusesResultsForOtherTermsAndSaysWhatToDo) {
  open();
  const auto other = ResultLog::open(file, {{"duration_s", 30}});
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("remove it, or choose another folder"), std::string::npos);
  EXPECT_NE(other.error().message.find(R"({"duration_s":20})"), std::string::npos);
}

TEST_F(ResultLogFile, RefusesAFileThatIsNoneOfIts) {
  std::filesystem::create_directories(file.parent_path());
  append("a diary\nof two lines\n");
  const auto log = ResultLog::open(file, kTerms);
  ASSERT_FALSE(log);
  EXPECT_NE(log.error().message.find("not results of this bench"), std::string::npos);
}

TEST(ResultLog, WithoutAFileIsKeptInMemory) {
  ResultLog log;
  ASSERT_TRUE(log.add("hall 1", {{"max_m", 0.25}}));
  EXPECT_TRUE(log.find("hall 1"));
}

}  // namespace
}  // namespace holdfast::benchmarks
