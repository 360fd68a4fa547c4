#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "evaluation/result/number_text.hpp"
#include "evaluation/result/result_keys.hpp"
#include "evaluation/result/result_table.hpp"
#include "evaluation/result/verdict.hpp"
#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Evaluation judged(double offset_m, double end = 30) {
  const auto where = [=](double t) { return straight(t) * pose(0, offset_m); };
  Result<Evaluation> e = evaluate(sample(0.1, end, 10, where), truth_of(30, straight));
  EXPECT_TRUE(e.ok());
  return std::move(*e);
}

TEST(NumberText, ShowsLengthsInMillimetresWhereTheyAreSmall) {
  EXPECT_EQ(length_text(0.00191), "1.9 mm");
  EXPECT_EQ(length_text(0.00019), "0.19 mm");
  EXPECT_EQ(length_text(0.0999), "99.9 mm");
  EXPECT_EQ(length_text(0.09999), "0.100 m");
  EXPECT_EQ(length_text(1.234), "1.23 m");
  EXPECT_EQ(length_text(1234), "1234 m");
  EXPECT_EQ(length_text(kNotKnown), "-");
}

TEST(NumberText, NeverRoundsASmallFailureAway) {
  EXPECT_EQ(share_text(1), "100 %");
  EXPECT_EQ(share_text(0.99999), "> 99.9 %");
  EXPECT_EQ(share_text(0.00001), "< 0.1 %");
  EXPECT_EQ(share_text(0), "0 %");
  EXPECT_EQ(share_text(0.9949), "99.5 %");
}

TEST(NumberText, GroupsThousands) {
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(count_text(1204), "1 204");
  EXPECT_EQ(count_text(1234567), "1 234 567");
  EXPECT_EQ(count_text(-1234), "-1 234");
}

TEST(ResultJson, HasTheStableKeysAndReadsBack) {
  const auto json = nlohmann::json::parse(result_json(judged(0.05)));
  EXPECT_NEAR(json.at("ate_rmse_m").get<double>(), 0.05, 1e-9);
  for (const char* key :
       {"ate_rmse_m",    "ate_median_m", "ate_p95_m", "ate_max_m",  "rot_rmse_deg",
        "rot_max_deg",   "coverage",     "success",   "misleading", "e2e_m",
        "rpe_10m",       "rpe_20m",      "rpe_50m",   "scans",      "claimed",
        "outside_truth", "in_truth_gap", "events",    "warnings",   "align"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json.at("scans"), 300);
  EXPECT_EQ(json.at("coverage"), 1.0);
  EXPECT_TRUE(json.at("rpe_50m").is_null()) << "30 m of way";
  EXPECT_TRUE(json.at("events").is_array());
}

TEST(ResultJson, OfARunWithoutClaimsHasNullsWhereNothingIsKnown) {
  RunContext context;
  context.steps = steps(0.1, 20, [](double) { return "LOST"; });
  const Result<Evaluation> e = evaluate({}, truth_of(20, straight), {}, context);
  ASSERT_TRUE(e.ok());
  const auto json = nlohmann::json::parse(result_json(*e));
  EXPECT_TRUE(json.at("ate_rmse_m").is_null());
  EXPECT_EQ(json.at("coverage"), 0.0);
  EXPECT_EQ(json.at("success"), 0.0);
}

TEST(ResultKeys, AreAllExplained) {
  const std::string reference = result_key_reference();
  for (const ResultKey& key : result_keys()) {
    EXPECT_THAT(reference, HasSubstr(std::string(key.key)));
    EXPECT_FALSE(key.meaning.empty());
  }
}

TEST(ResultTable, HasColoursOnlyWhenAsked) {
  const Evaluation e = judged(0.002);
  EXPECT_THAT(result_table(e, false), Not(HasSubstr("\x1b")));
  EXPECT_THAT(result_table(e, true), HasSubstr("\x1b[1;32m"));
  EXPECT_THAT(result_table(e, false), HasSubstr("2.0 mm"));
}

TEST(Verdict, IsGreenForAGoodRun) {
  EXPECT_EQ(judge(judged(0.002)).light, Verdict::Light::kGreen);
  EXPECT_EQ(judge(judged(0.002)).headline, "Localized to 2.0 mm");
}

TEST(Verdict, IsRedWhenOneScanMisleads) {
  const auto where = [](double t) { return straight(t) * pose(0, std::abs(t - 9) < 0.01); };
  const Result<Evaluation> e = evaluate(sample(0.1, 30, 10, where), truth_of(30, straight));
  ASSERT_TRUE(e.ok());
  EXPECT_EQ(e->misleading.count, 1U);
  EXPECT_EQ(judge(*e).light, Verdict::Light::kRed);
}

TEST(Verdict, IsAmberWithSomeGapsAndRedWithMany) {
  EXPECT_EQ(judge(judged(0.002, 29)).light, Verdict::Light::kAmber);
  EXPECT_EQ(judge(judged(0.002, 20)).light, Verdict::Light::kRed);
}

TEST(Verdict, WithoutATruthIsNeverGreen) {
  const Evaluation e = judged(0);
  EXPECT_EQ(judge_without_truth(e.series, true).light, Verdict::Light::kNone);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
