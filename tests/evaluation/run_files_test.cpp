#include "evaluation/files/run_files.hpp"

#include <gmock/gmock.h>

#include "evaluation/files/event_file.hpp"
#include "evaluation/files/map_view.hpp"
#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kHeader =
    "stamp,pose_time,status,reason,p_wrong,matches,inlier_share,mean_abs_residual,"
    "weak_directions,sigma_trans,sigma_rot,odom_epoch,ms_total,ms_deskew,ms_solve\n";

TEST(StepsFile, IsReadWithAllItsColumns) {
  const RunFolder run;
  const auto file = run.put(
      "steps.csv", std::string(kHeader) +
                       "1317042504.599424001,1317042504.699424002,DEGRADED,\"along, \"\"x\"\"\","
                       "0.01,900,0.91,0.012,(1 0 0);(0 3 4),0.002,0.001,4,0.8,0.1,0.6\n");
  const Result<StepTable> steps = read_steps(file);
  ASSERT_TRUE(steps.ok()) << steps.error().message;
  EXPECT_THAT(steps->stages, ElementsAre("deskew", "solve"));
  ASSERT_EQ(steps->rows.size(), 1U);
  const StepRow& row = steps->rows[0];
  EXPECT_EQ(row.stamp, 1317042504599424001);
  EXPECT_EQ(row.pose_time, 1317042504699424002);
  EXPECT_EQ(row.status, "DEGRADED");
  EXPECT_EQ(row.reason, "along, \"x\"");
  EXPECT_EQ(row.p_wrong, 0.01);
  EXPECT_EQ(row.matches, 900);
  EXPECT_EQ(row.inlier_share, 0.91);
  EXPECT_EQ(row.mean_abs_residual_m, 0.012);
  ASSERT_EQ(row.weak_directions.size(), 2U);
  EXPECT_NEAR((row.weak_directions[1] - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 0, 1e-15);
  EXPECT_EQ(row.sigma_trans_m, 0.002);
  EXPECT_EQ(row.sigma_rot_rad, 0.001);
  EXPECT_EQ(row.odom_epoch, 4);
  EXPECT_EQ(row.ms_total, 0.8);
  EXPECT_THAT(row.ms_stages, ElementsAre(0.1, 0.6));
}

TEST(StepsFile, MayHaveMoreColumnsInAnotherOrderAndEmptyValues) {
  const RunFolder run;
  const auto file = run.put("steps.csv",
                            "colour,status,pose_time,ms_solve,matches\r\n"
                            "blue,TRACKING,1.5,,\r\n"
                            "\"a,b\",LOST,1.6,0.5,12\r\n");
  const Result<StepTable> steps = read_steps(file);
  ASSERT_TRUE(steps.ok()) << steps.error().message;
  ASSERT_EQ(steps->rows.size(), 2U);
  EXPECT_EQ(steps->rows[0].stamp, steps->rows[0].pose_time);
  EXPECT_TRUE(std::isnan(steps->rows[0].matches));
  EXPECT_TRUE(std::isnan(steps->rows[0].ms_stages[0]));
  EXPECT_EQ(steps->rows[1].status, "LOST");
  EXPECT_EQ(steps->rows[1].matches, 12);
}

TEST(StepsFile, ThatWasCutOffLosesItsLastLineOnly) {
  const RunFolder run;
  const std::string whole =
      "pose_time,status,matches\n1.1,TRACKING,10\n1.2,TRACKING,20\n1.3,TRACKING,30\n";
  for (const std::size_t cut : {3U, 8U, 14U}) {
    const Result<StepTable> steps =
        read_steps(run.put("steps.csv", whole.substr(0, whole.size() - cut)));
    ASSERT_TRUE(steps.ok()) << steps.error().message;
    EXPECT_EQ(steps->rows.size(), cut == 3 ? 3U : 2U);
    EXPECT_EQ(steps->truncated, cut != 3) << "without its last digit a line still reads";
  }
}

TEST(StepsFile, ErrorsNameFileLineColumnAndWhatWasFound) {
  const RunFolder run;
  const auto message = [&](const std::string& content) {
    const Result<StepTable> steps = read_steps(run.put("steps.csv", content));
    return steps.ok() ? std::string("no error") : steps.error().message;
  };
  EXPECT_THAT(message("pose_time,status,matches\n1,TRACKING,5\n2,TRACKING,many\n"),
              AllOf(HasSubstr("steps.csv: line 3"), HasSubstr("matches"), HasSubstr("\"many\"")));
  EXPECT_THAT(message("pose_time,status\n1,TRACKING,5\n2,TRACKING\n"),
              AllOf(HasSubstr("steps.csv: line 2"), HasSubstr("expected 2"), HasSubstr("found 3")));
  EXPECT_THAT(message("pose_time,status\n1,FINE\n"),
              AllOf(HasSubstr("status"), HasSubstr("\"FINE\"")));
  EXPECT_THAT(message("pose_time,status\n2,LOST\n1,LOST\n"),
              AllOf(HasSubstr("steps.csv: line 3"), HasSubstr("after 2.000000000")));
  EXPECT_THAT(message("stamp,status\n1,LOST\n"),
              AllOf(HasSubstr("steps.csv: line 1"), HasSubstr("pose_time")));
  EXPECT_THAT(message(""), HasSubstr("empty file"));
}

TEST(StepsFile, ThatIsNotThereIsNamed) {
  const Result<StepTable> steps = read_steps("/nowhere/steps.csv");
  ASSERT_FALSE(steps.ok());
  EXPECT_THAT(steps.error().message,
              AllOf(HasSubstr("/nowhere/steps.csv"), HasSubstr("No such file")));
}

TEST(Statuses, ThatClaimAPoseAreThoseOfTheContract) {
  for (const char* status : {"TRACKING", "DEGRADED", "DEAD_RECKONING", "UNMAPPED", "SUSPECT"})
    EXPECT_TRUE(status_claims_pose(status)) << status;
  for (const char* status : {"INITIALIZING", "LOST", "RELOCALIZING", "", "tracking"})
    EXPECT_FALSE(status_claims_pose(status)) << status;
  EXPECT_TRUE(status_is_trusted("DEGRADED"));
  EXPECT_FALSE(status_is_trusted("SUSPECT"));
}

TEST(SummaryFile, IsReadAndMayLackKeys) {
  const RunFolder run;
  const auto file = run.put("summary.json", R"({
    "scans": 600, "method": "map_filter", "step_ms": {"p50": 0.7, "max": 2},
    "status_share": {"TRACKING": 0.99, "LOST": 0.01},
    "counters": {"log": {"empty_scans": 3, "truncated": true}, "held": 1},
    "warnings": ["one thing"], "new_key": [1, 2]})");
  const Result<RunSummary> summary = read_summary(file);
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->scans, 600);
  EXPECT_EQ(summary->method, "map_filter");
  EXPECT_EQ(summary->step_ms.p50, 0.7);
  EXPECT_TRUE(std::isnan(summary->step_ms.p99));
  EXPECT_TRUE(std::isnan(summary->peak_rss_mb));
  using Entry = std::pair<std::string, double>;
  EXPECT_THAT(summary->status_share, ElementsAre(Entry("TRACKING", 0.99), Entry("LOST", 0.01)));
  EXPECT_THAT(summary->counters, ElementsAre(Entry("log.empty_scans", 3), Entry("log.truncated", 1),
                                             Entry("held", 1)));
  EXPECT_THAT(summary->warnings, ElementsAre("one thing"));
}

TEST(SummaryFile, ThatIsCutOffOrNoObjectIsAnError) {
  const RunFolder run;
  for (const char* content : {"{\"scans\": 6", "[1]", ""}) {
    const Result<RunSummary> summary = read_summary(run.put("summary.json", content));
    ASSERT_FALSE(summary.ok()) << content;
    EXPECT_THAT(summary.error().message, HasSubstr("summary.json"));
  }
}

TEST(EventFile, HoldsSimulatedEventsAndThoseOfARun) {
  const RunFolder run;
  const auto file = run.put("events.jsonl",
                            R"({"t0": 40.5, "t1": 42, "event": "blind"}
{"t0": 30, "event": "kidnap"}

{"t": 31, "event": "status", "from": "TRACKING", "to": "LOST", "score": 0.5}
)");
  const Result<EventList> list = read_events(file);
  ASSERT_TRUE(list.ok()) << list.error().message;
  ASSERT_EQ(list->events.size(), 3U);
  EXPECT_EQ(list->events[0].name, "kidnap");
  EXPECT_EQ(list->events[0].t1, 30 * kSecond);
  using Entry = std::pair<std::string, std::string>;
  EXPECT_THAT(list->events[1].details,
              ElementsAre(Entry("from", "TRACKING"), Entry("to", "LOST"), Entry("score", "0.5")));
  EXPECT_EQ(list->events[2].t0, from_seconds(40.5));
  EXPECT_EQ(list->events[2].t1, 42 * kSecond);
}

TEST(EventFile, ThatWasCutOffLosesItsLastLineOnly) {
  const RunFolder run;
  const auto file = run.put("events.jsonl", "{\"t\": 1, \"event\": \"alarm\"}\n{\"t\": 2, \"ev");
  const Result<EventList> list = read_events(file);
  ASSERT_TRUE(list.ok()) << list.error().message;
  EXPECT_EQ(list->events.size(), 1U);
  EXPECT_TRUE(list->truncated);
}

TEST(EventFile, ErrorsNameFileAndLine) {
  const RunFolder run;
  const auto message = [&](const std::string& line) {
    const Result<EventList> list =
        read_events(run.put("events.jsonl", "{\"t\": 1, \"event\": \"a\"}\n" + line + "\n"));
    return list.ok() ? std::string("no error") : list.error().message;
  };
  EXPECT_THAT(message("{\"t\": 2, \"ev"), HasSubstr("events.jsonl: line 2"));
  EXPECT_THAT(message("{\"t\": 2}"),
              AllOf(HasSubstr("events.jsonl: line 2"), HasSubstr("\"event\"")));
  EXPECT_THAT(message("{\"event\": \"a\"}"), HasSubstr("expected a time"));
  EXPECT_THAT(message("{\"t\": \"soon\", \"event\": \"a\"}"), HasSubstr("found \"soon\""));
  EXPECT_THAT(message("{\"t0\": 2, \"t1\": 1, \"event\": \"a\"}"), HasSubstr("t1"));
  EXPECT_THAT(message("{\"t\": 1e30, \"event\": \"a\"}"), HasSubstr("expected seconds"));
}

TEST(MapViewFile, IsReadAndThinnedOut) {
  const RunFolder run;
  std::string points = "{\"bounds\": 0, \"points\": [[0, 1, 2]";
  for (int i = 1; i < 100'000; ++i) points += ",[" + std::to_string(i) + ",1,2]";
  const Result<MapView> view = read_map_view(run.put("map_view.json", points + "]}"));
  ASSERT_TRUE(view.ok()) << view.error().message;
  EXPECT_EQ(view->points.size(), 50'000U);
  EXPECT_EQ(view->points[1], Eigen::Vector3f(2, 1, 2));
}

TEST(MapViewFile, ErrorsNameFileAndPoint) {
  const RunFolder run;
  const auto message = [&](const std::string& content) {
    const Result<MapView> view = read_map_view(run.put("map_view.json", content));
    return view.ok() ? std::string("no error") : view.error().message;
  };
  EXPECT_THAT(message("{\"points\": [[1,2,3],[1,2]]}"), HasSubstr("points[1]"));
  EXPECT_THAT(message("{\"points\": [[1,2,null]]}"), HasSubstr("three finite numbers"));
  EXPECT_THAT(message("{\"points\": [[1,2"), HasSubstr("map_view.json"));
  EXPECT_THAT(message("{}"), HasSubstr("\"points\""));
}

}  // namespace
}  // namespace holdfast::evaluation::testing
