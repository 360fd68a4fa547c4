#include "benchmarks/bench.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"

namespace holdfast::benchmarks {
namespace {

TEST(Seeds, AreReadWithBothEndsIncluded) {
  const auto seeds = parse_seeds("3:12");
  ASSERT_TRUE(seeds) << seeds.error().message;
  EXPECT_EQ(seeds->first, 3U);
  EXPECT_EQ(seeds->last, 12U);
  EXPECT_EQ(seeds->count(), 10U);
  EXPECT_EQ(parse_seeds("7")->count(), 1U);
}

TEST(Seeds, OfAnotherFormAreRefusedWithTheFormExpected) {
  for (const char* text : {"", ":", "1:", ":2", "a:b", "1:2:3", "-1:2", "2:1", "1:2000", "1 :2"}) {
    const auto seeds = parse_seeds(text);
    ASSERT_FALSE(seeds) << text;
    EXPECT_NE(seeds.error().message.find("expected A"), std::string::npos);
  }
}

TEST(Benches, AreFoundByNameAndListedOtherwise) {
  ASSERT_TRUE(find_bench("accuracy"));
  EXPECT_EQ((*find_bench("accuracy"))->seeds.count(), 10U);
  const auto unknown = find_bench("acuracy");
  ASSERT_FALSE(unknown);
  for (const BenchInfo& info : benches()) {
    EXPECT_NE(unknown.error().message.find(info.name), std::string::npos);
  }
}

TEST(Figures, OfADistributionAreItsQuantiles) {
  std::vector<double> values;
  for (int i = 100; i >= 0; --i) values.push_back(i);
  const Distribution d = distribution_of(values);
  EXPECT_EQ(d.p50, 50);
  EXPECT_EQ(d.p95, 95);
  EXPECT_EQ(d.p99, 99);
  EXPECT_NEAR(d.p999, 99.9, 1e-9);
  EXPECT_EQ(d.max, 100);
  EXPECT_TRUE(json_of(distribution_of({}))["p50"].is_null());
}

TEST(Figures, ThatAreNotKnownAreNull) {
  EXPECT_TRUE(known(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_TRUE(known(std::numeric_limits<double>::quiet_NaN()).is_null());
  EXPECT_EQ(known(0.25).get<double>(), 0.25);
  EXPECT_EQ(ratio_text(11.74), "11.7 x");
  EXPECT_EQ(ratio_text(std::numeric_limits<double>::quiet_NaN()), "-");
}

TEST(ScratchFolder, IsGoneWithAllItHeldWhenItsOwnerIs) {
  std::filesystem::path path;
  {
    auto scratch = ScratchFolder::create();
    ASSERT_TRUE(scratch) << scratch.error().message;
    const ScratchFolder moved = std::move(*scratch);
    path = moved.path();
    std::ofstream(moved / "file") << "content";
    EXPECT_TRUE(std::filesystem::exists(moved / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Report, SaysHowItCameAboutAndLiesInTwoFiles) {
  auto scratch = ScratchFolder::create();
  ASSERT_TRUE(scratch) << scratch.error().message;
  const BenchInfo info{"probe",
                       "a bench for this test",
                       {1, 1},
                       1,
                       [](const BenchOptions& options) -> Result<BenchReport> {
                         BenchReport report;
                         report.data["results"] = {{"answer", options.duration_s}};
                         report.markdown = "| answer |\n";
                         return report;
                       }};
  BenchOptions options;
  options.seeds = {4, 6};
  options.duration_s = 42;
  const auto report = run_bench(info, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_TRUE(write_report(info, *report, *scratch / "out"));
  std::ifstream file(*scratch / "out" / "probe.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["results"]["answer"], 42);
  EXPECT_EQ(json["seeds"], nlohmann::json({4, 6}));
  EXPECT_EQ(json["command"],
            "holdfast bench probe --out DIR --seeds 4:6 --duration 42 --threads 1");
  EXPECT_FALSE(json["cpu"].get<std::string>().empty());
  std::ifstream table(*scratch / "out" / "probe.md");
  const std::string text{std::istreambuf_iterator<char>(table), {}};
  EXPECT_NE(text.find("| answer |"), std::string::npos);
  EXPECT_NE(text.find("--seeds 4:6"), std::string::npos);
}

TEST(Report, OfAFailedBenchIsItsError) {
  const BenchInfo info{"probe", "", {1, 1}, 1, [](const BenchOptions&) -> Result<BenchReport> {
                         return Error{"no world to measure in"};
                       }};
  const auto report = run_bench(info, {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "no world to measure in");
}

TEST(Settings, AreCheckedBeforeTheFirstDrive) {
  const BenchInfo fixed{"probe", "", {1, 1}, 1, [](const BenchOptions&) -> Result<BenchReport> {
                          return BenchReport{{{"answer", 42}}, ""};
                        }};
  BenchInfo settable = fixed;
  settable.takes_settings = true;
  BenchOptions options;
  options.settings = {"method=graph"};
  EXPECT_NE(run_bench(fixed, options).error().message.find("takes no --set"), std::string::npos);
  const auto report = run_bench(settable, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_NE(report->markdown.find("--set \"method=graph\""), std::string::npos);
  options.settings = {"map_filter.gate=1"};
  EXPECT_NE(run_bench(settable, options).error().message.find("gate_m"), std::string::npos);
}

TEST(ConsistencyBench, JudgesTheMethodThatIsSet) {
  BenchOptions options;
  options.duration_s = 4;
  options.settings = {"method=graph"};
  const auto report = run_bench(**find_bench("consistency"), options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->data["results"].size(), 7U);
  for (const auto& result : report->data["results"]) {
    ASSERT_EQ(result["methods"].size(), 1U);
    const auto& graph = result["methods"][0];
    EXPECT_EQ(graph["method"], "graph");
    EXPECT_EQ(graph["claims_without_covariance"], 0);
    EXPECT_EQ(graph["failed"], 0);
    EXPECT_EQ(graph["nees_by_axis"].size(), 6U);
    EXPECT_GT(graph["instants"].get<int>(), 15) << result["scenario"];
    EXPECT_GT(graph["nees"].get<double>(), 0) << result["scenario"];
  }
}

TEST(AblationBench, RunsEveryVariantOnTheSameDrives) {
  BenchOptions options;
  options.duration_s = 4;
  const auto report = run_bench(**find_bench("ablation"), options);
  ASSERT_TRUE(report) << report.error().message;
  const auto& results = report->data["results"];
  ASSERT_GE(results.size(), 3U);
  EXPECT_EQ(results[0]["variant"], "full");
  for (const auto& variant : results) {
    ASSERT_EQ(variant["scenarios"].size(), 3U);
    for (const auto& scenario : variant["scenarios"]) {
      EXPECT_FALSE(scenario["drives"][0].contains("failure")) << variant["variant"];
      if (variant["article_rmse_m"].is_null()) continue;
      EXPECT_GT(scenario["ate_rmse_worst_m"].get<double>(), 0) << variant["variant"];
      EXPECT_LT(scenario["ate_rmse_worst_m"].get<double>(), 0.05) << variant["variant"];
    }
  }
}

TEST(SimulatorBench, KeepsItsKeys) {
  BenchOptions options;
  options.duration_s = 0.5;
  const auto report = run_bench(**find_bench("simulator"), options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->data["results"].size(), 5U);
  for (const auto& result : report->data["results"]) {
    for (const char* kind : {"in_process", "to_bag", "in_process_1_thread"}) {
      EXPECT_GT(result[kind]["realtime_factor"].get<double>(), 0) << result["scenario"];
      EXPECT_NEAR(result[kind]["simulated_s"].get<double>(), 0.5, 0.1) << result["scenario"];
    }
  }
  const auto& cloud = report->data["cloud"];
  EXPECT_GT(cloud["in_process"]["realtime_factor"].get<double>(), 0);
  EXPECT_GT(cloud["discs"].get<std::size_t>(), 2'500'000U);
  for (const char* key : {"discs_s", "way_s", "tree_s", "peak_rss_mb"}) {
    EXPECT_GT(cloud[key].get<double>(), 0) << key;
  }
}

}  // namespace
}  // namespace holdfast::benchmarks
