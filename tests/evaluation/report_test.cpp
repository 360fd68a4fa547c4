#include "evaluation/report/report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "evaluation/report/page_assets.hpp"
#include "holdfast/io/tum_file.hpp"
#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

/// A run of 20 s with everything a report can show; its error is 5 cm to the left.
void put_run(const RunFolder& run) {
  const auto where = [](double t) { return straight(t) * pose(0, 0.05); };
  ASSERT_TRUE(io::write_tum(run / "truth.tum", truth_of(20, straight)).ok());
  ASSERT_TRUE(io::write_tum(run / "trajectory.tum", sample(0.1, 20, 10, where)).ok());
  std::string steps = "pose_time,status,reason,matches,mean_abs_residual,ms_total,ms_solve\n";
  for (int i = 1; i <= 200; ++i)
    steps += format_seconds(i * (kSecond / 10)) + ",TRACKING,</script><b>,800,0.012,0.5,0.4\n";
  run.put("steps.csv", steps);
  run.put("events.jsonl", "{\"t\": 5, \"event\": \"alarm\", \"reason\": \"a < b\"}\n");
  run.put("sim_events.jsonl", "{\"t0\": 10, \"event\": \"imu_bias_jump\"}\n");
  run.put("summary.json", R"({"scans": 200, "step_ms": {"p50": 0.5, "p99": 0.9},
    "counters": {"invalid_points": 7}})");
  run.put("map_view.json", R"({"points": [[0, 0, 0], [10, -2, 3], [20.5, 4, 1]]})");
}

ReportOptions judged_by(const RunFolder& run) {
  ReportOptions options;
  options.truth = run / "truth.tum";
  options.events = run / "sim_events.jsonl";
  return options;
}

std::string written_report(const RunFolder& run, const ReportOptions& options = {}) {
  const auto path = write_report(run.path(), options);
  EXPECT_TRUE(path.ok()) << (path.ok() ? "" : path.error().message);
  return run.read("report.html");
}

json payload_of(const std::string& html) {
  const std::string open = "<script id=\"payload\" type=\"application/json\">";
  const std::size_t begin = html.find(open) + open.size();
  return json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(Report, HoldsItsDataAsJsonThatReadsBack) {
  const RunFolder run;
  put_run(run);
  const json data = payload_of(written_report(run, judged_by(run)));
  const json& scans = data.at("scans");
  ASSERT_EQ(scans.at("t").size(), 200U);
  EXPECT_NEAR(scans.at("t")[10].get<double>(), 1, 1e-9);
  EXPECT_THAT(scans.at("error_m").get<std::vector<double>>(),
              Each(::testing::DoubleNear(0.05, 1e-6)));
  EXPECT_EQ(scans.at("statuses")[scans.at("status")[0].get<int>()], "TRACKING");
  EXPECT_EQ(scans.at("reasons")[scans.at("reason")[0].get<int>()], "</script><b>");
  EXPECT_EQ(scans.at("stages").at("solve")[7], 0.4);
  EXPECT_EQ(scans.at("residual_m")[7], 0.012);
  EXPECT_FALSE(scans.contains("p_wrong")) << "no figure, no panel";
  EXPECT_EQ(data.at("verdict").at("light"), "good");
  EXPECT_EQ(data.at("events").size(), 2U);
  EXPECT_EQ(data.at("warnings")[0], "7 points were not finite and were dropped");
}

/// Undoes base64 and quantisation as the page does.
std::vector<Eigen::Vector3d> points_of(const json& map) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> bytes;
  int bits = 0;
  int value = 0;
  for (const char c : map.at("xyz").get<std::string>()) {
    if (c == '=') break;
    value = (value << 6 | static_cast<int>(letters.find(c))) & 0xFFFF;
    if ((bits += 6) >= 8) bytes.push_back(value >> (bits -= 8) & 255);
  }
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + 5 < bytes.size(); i += 6) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k)
      p[k] = map.at("min")[k].get<double>() +
             map.at("step")[k].get<double>() * (bytes[i + 2 * k] | bytes[i + 2 * k + 1] << 8);
    points.push_back(p);
  }
  return points;
}

TEST(Report, HoldsTheMapWithinASixtyThousandthOfItsExtent) {
  const RunFolder run;
  put_run(run);
  const std::vector<Eigen::Vector3d> points = points_of(payload_of(written_report(run)).at("map"));
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR((points[0] - Eigen::Vector3d(0, 0, 0)).norm(), 0, 1e-3);
  EXPECT_NEAR((points[1] - Eigen::Vector3d(10, -2, 3)).norm(), 0, 1e-3);
  EXPECT_NEAR((points[2] - Eigen::Vector3d(20.5, 4, 1)).norm(), 0, 1e-3);
}

TEST(Report, NamesNoAddressAndForbidsEveryRequest) {
  const RunFolder run;
  put_run(run);
  const std::string html = written_report(run, judged_by(run));
  EXPECT_THAT(html, HasSubstr("Content-Security-Policy"));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("http:")));
  EXPECT_THAT(html, Not(HasSubstr("https:")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(HasSubstr("{{")));
  const std::regex loads(R"re(\b(src|href)\s*=\s*["']?(?!data:)[^"'\s>])re");
  EXPECT_FALSE(std::regex_search(html, loads));
}

TEST(Report, CarriesTheLicenceOfWhatItEmbeds) {
  const RunFolder run;
  put_run(run);
  EXPECT_THAT(written_report(run), AllOf(HasSubstr("Leon Sorokin"), HasSubstr("MIT License")));
}

TEST(Report, TextOfARunCannotEndTheScriptThatHoldsIt) {
  const RunFolder run;
  put_run(run);
  ReportOptions options;
  options.title = "<img onerror=x> & \"run\"";
  const std::string html = written_report(run, options);
  EXPECT_THAT(html, HasSubstr("<title>&lt;img onerror=x&gt; &amp; &quot;run&quot;"));
  EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
  EXPECT_EQ(payload_of(html).at("title"), options.title);
}

TEST(Report, OfATrajectoryAloneIsWritten) {
  const RunFolder run;
  ASSERT_TRUE(io::write_tum(run / "trajectory.tum", sample(0.1, 20, 10, straight)).ok());
  const json data = payload_of(written_report(run));
  EXPECT_TRUE(data.at("map").is_null());
  EXPECT_TRUE(data.at("truth").is_null());
  EXPECT_FALSE(data.at("scans").contains("error_m"));
  EXPECT_NE(data.at("verdict").at("light"), "good");
  EXPECT_EQ(data.at("title"), run.path().filename().string());
}

TEST(Report, OfARunThatNeverClaimedIsWritten) {
  const RunFolder run;
  put_run(run);
  run.put("trajectory.tum", "");
  const json data = payload_of(written_report(run, judged_by(run)));
  EXPECT_EQ(data.at("verdict").at("light"), "bad");
  EXPECT_EQ(data.at("verdict").at("headline"), "No pose was claimed");
  EXPECT_FALSE(data.at("scans").contains("x"));
}

TEST(Report, ADamagedMapOrSummaryCostsOnlyItsPanel) {
  const RunFolder run;
  put_run(run);
  run.put("map_view.json", "{\"points\": [[1, 2");
  run.put("summary.json", "{");
  const json data = payload_of(written_report(run));
  EXPECT_TRUE(data.at("map").is_null());
  ASSERT_EQ(data.at("warnings").size(), 2U);
  EXPECT_THAT(data.at("warnings")[0].get<std::string>(), HasSubstr("summary.json"));
  EXPECT_THAT(data.at("warnings")[1].get<std::string>(), HasSubstr("map_view.json"));
}

TEST(Report, TruncatedStepsAreUsedAndSaidSo) {
  const RunFolder run;
  put_run(run);
  const std::string steps = run.read("steps.csv");
  run.put("steps.csv", steps.substr(0, steps.size() / 2));
  const json data = payload_of(written_report(run));
  EXPECT_THAT(data.at("warnings")[0].get<std::string>(), HasSubstr("middle of a line"));
}

TEST(Report, OfAnotherTrajectoryDoesNotReplaceThatOfTheRun) {
  const RunFolder run;
  put_run(run);
  ASSERT_TRUE(io::write_tum(run / "rival.tum", sample(0.1, 20, 10, straight)).ok());
  ReportOptions options = judged_by(run);
  options.trajectory = run / "rival.tum";
  const auto path = write_report(run.path(), options);
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(*path, run / "report_rival.html");
  const json data = payload_of(run.read("report_rival.html"));
  EXPECT_FALSE(data.at("scans").contains("matches")) << "the steps are those of the run";
  EXPECT_FALSE(std::filesystem::exists(run / "report.html"));
}

TEST(Report, WithoutATrajectoryIsAnErrorAndLeavesNothing) {
  const RunFolder run;
  const auto path = write_report(run.path());
  ASSERT_FALSE(path.ok());
  EXPECT_THAT(path.error().message, HasSubstr("trajectory.tum"));
  EXPECT_FALSE(std::filesystem::exists(run / "report.html"));
}

TEST(Report, IsTheSameBytesTwice) {
  const RunFolder run;
  put_run(run);
  const std::string once = written_report(run, judged_by(run));
  EXPECT_EQ(once, written_report(run, judged_by(run)));
}

TEST(Report, TellsWhatARunReportedInWords) {
  const RunFolder run;
  put_run(run);
  run.put("events.jsonl",
          "{\"t\":1,\"event\":\"status\",\"from\":\"\",\"to\":\"TRACKING\",\"reason\":\"\"}\n"
          "{\"t\":2,\"event\":\"status\",\"from\":\"TRACKING\",\"to\":\"LOST\",\"p\":0.9,"
          "\"reason\":\"glass\"}\n"
          "{\"t\":3,\"event\":\"alarm\",\"reason\":\"a < b\"}\n");
  const json events = payload_of(written_report(run)).at("events");
  EXPECT_EQ(events[0].at("text"), "TRACKING");
  EXPECT_EQ(events[1].at("text"), "TRACKING to LOST: p 0.9, glass");
  EXPECT_EQ(events[2].at("text"), "a < b");
}

TEST(Report, ShowsTheEvidenceOfAnAlarmAndTheCandidatesOfASearch) {
  const RunFolder run;
  put_run(run);
  run.put("events.jsonl",
          "{\"t\":1,\"event\":\"alarm\",\"reason\":\"lost\",\"evidence\":[{\"witness\":\"way\","
          "\"log_ratio\":2.5,\"text\":\"another way\"}]}\n"
          "{\"t\":2,\"event\":\"search\",\"outcome\":\"found\",\"reason\":\"one pose\","
          "\"accepted\":true,\"scans\":3,\"cpu_ms\":12.4,\"candidates\":[{\"pose\":[1,2,0,0,0,"
          "0.70710678,0.70710678],\"score\":0.9,\"agreeing\":0.6,\"probability\":0.75}]}\n"
          "{\"t\":3,\"event\":\"search\",\"candidates\":[7,{\"pose\":[1]},{}],\"evidence\":3}\n");
  const json events = payload_of(written_report(run)).at("events");
  EXPECT_EQ(events[0].at("text"), "lost");
  EXPECT_EQ(events[0].at("lines")[0], "+2.5 another way");
  EXPECT_FALSE(events[0].contains("candidates"));
  EXPECT_EQ(events[1].at("text"), "accepted, one pose: 3 scans, 12 ms");
  ASSERT_EQ(events[1].at("candidates").size(), 1U);
  EXPECT_EQ(events[1].at("candidates")[0].at("x"), 1.0);
  EXPECT_NEAR(events[1].at("candidates")[0].at("yaw").get<double>(), 90.0, 1e-5);
  EXPECT_NE(events[1].at("lines")[0].get<std::string>().find("75 % likely"), std::string::npos);
  EXPECT_FALSE(events[2].contains("candidates"));
}

TEST(Report, TruthIsBrokenAtATeleport) {
  const RunFolder run;
  put_run(run);
  Trajectory truth = sample(0, 10, 200, straight);
  const Trajectory after = sample(10, 20, 200, [](double t) { return pose(t, 30); });
  truth.insert(truth.end(), after.begin(), after.end());
  ASSERT_TRUE(io::write_tum(run / "truth.tum", truth).ok());
  const json path = payload_of(written_report(run, judged_by(run))).at("truth");
  int breaks = 0;
  for (const json& x : path.at("x")) breaks += x.is_null() ? 1 : 0;
  EXPECT_EQ(breaks, 1);
}

TEST(PageAssets, HoldEveryFileOfThePage) {
  const auto page = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path() /
                    "evaluation" / "report" / "page";
  ASSERT_TRUE(std::filesystem::exists(page));
  for (const auto& file : std::filesystem::directory_iterator(page))
    EXPECT_FALSE(page_asset(file.path().filename().string()).empty()) << file.path();
  EXPECT_TRUE(page_asset("none.js").empty());
}

}  // namespace
}  // namespace holdfast::evaluation::testing
