#include <gmock/gmock.h>

#include "evaluation/evaluate.hpp"
#include "evaluation/result/result_keys.hpp"
#include "holdfast/io/tum_file.hpp"
#include "tests/evaluation/scenes.hpp"

namespace holdfast::evaluation::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The message of an evaluation that must fail.
std::string failure(const std::filesystem::path& estimate, const std::filesystem::path& truth,
                    const std::filesystem::path& events = {}) {
  const Result<Evaluation> result = evaluate_files({estimate, truth, events}, {});
  return result.ok() ? std::string("no error") : result.error().message;
}

std::filesystem::path put_tum(const RunFolder& run, const char* name, const Trajectory& poses) {
  EXPECT_TRUE(io::write_tum(run / name, poses).ok());
  return run / name;
}

std::string steps_text(double end, const char* status) {
  std::string text = "pose_time,status\n";
  for (int i = 1; i <= std::llround(10 * end); ++i)
    text += format_seconds(i * (kSecond / 10)) + "," + status + "\n";
  return text;
}

TEST(EvaluateFiles, UsesTheStepsBesideARunsTrajectory) {
  const RunFolder run;
  run.put("steps.csv", steps_text(30, "DEGRADED"));
  run.put("events.jsonl", "{\"t\": 5, \"event\": \"relocalized\"}\n");
  const auto truth = put_tum(run, "truth.tum", truth_of(30, straight));
  const auto estimate = put_tum(run, "trajectory.tum", sample(0.1, 20, 10, straight));
  const Result<Evaluation> e = evaluate_files({estimate, truth, {}}, {});
  ASSERT_TRUE(e.ok()) << e.error().message;
  EXPECT_TRUE(e->from_steps);
  EXPECT_EQ(e->scans, 300U);
  EXPECT_EQ(e->claimed, 200U);
  EXPECT_EQ(e->relocalizations.size(), 1U);
  const auto other = put_tum(run, "other.tum", sample(0.1, 20, 10, straight));
  const Result<Evaluation> of_other = evaluate_files({other, truth, {}}, {});
  ASSERT_TRUE(of_other.ok());
  EXPECT_FALSE(of_other->from_steps) << "a stranger's file has nothing to do with these steps";
}

TEST(EvaluateFiles, AnEmptyTrajectoryWithStepsIsACoverageOfZero) {
  const RunFolder run;
  run.put("steps.csv", steps_text(10, "INITIALIZING"));
  const auto truth = put_tum(run, "truth.tum", truth_of(10, straight));
  const Result<Evaluation> e = evaluate_files({run.put("trajectory.tum", ""), truth, {}}, {});
  ASSERT_TRUE(e.ok()) << e.error().message;
  EXPECT_EQ(e->coverage.count, 0U);
  EXPECT_EQ(e->coverage.of, 80U);
}

TEST(EvaluateFiles, MissingAndEmptyFilesAreNamed) {
  const RunFolder run;
  const auto good = put_tum(run, "good.tum", truth_of(3, straight));
  EXPECT_THAT(failure(run / "none.tum", good), AllOf(HasSubstr("none.tum"), HasSubstr("No such")));
  EXPECT_THAT(failure(good, run / "none.tum"), HasSubstr("none.tum"));
  EXPECT_THAT(failure(good, good, run / "none.jsonl"), HasSubstr("none.jsonl"));
  EXPECT_THAT(failure(run.put("empty.tum", "\n"), good),
              AllOf(HasSubstr("empty.tum"), HasSubstr("holds no pose")));
  EXPECT_THAT(failure(good, run.put("empty.tum", "")), HasSubstr("empty.tum holds no pose"));
  EXPECT_THAT(failure(run.path(), good), HasSubstr("found a folder"));
}

TEST(EvaluateFiles, ATruncatedTrajectoryIsAnErrorThatNamesTheLine) {
  const RunFolder run;
  const auto good = put_tum(run, "good.tum", truth_of(3, straight));
  const std::string text = run.read("good.tum");
  const auto cut = run.put("cut.tum", text.substr(0, text.size() - 30));
  EXPECT_THAT(failure(cut, good), HasSubstr("cut.tum: line 601"));
}

TEST(EvaluateFiles, WithoutOverlapBothSpansAreTold) {
  const RunFolder run;
  const auto late = put_tum(run, "late.tum", sample(1000, 1010, 10, straight));
  const auto truth = put_tum(run, "truth.tum", truth_of(10, straight));
  EXPECT_THAT(failure(late, truth),
              AllOf(HasSubstr("no overlap in time"), HasSubstr("1000.000 to 1010.000 s"),
                    HasSubstr("0.000 to 10.000 s")));
}

TEST(EvaluateFiles, NanosecondsForSecondsAreRecognized) {
  const RunFolder run;
  const auto truth =
      put_tum(run, "truth.tum", sample(1317042504, 1317042510, 100, [](double) { return SE3{}; }));
  const auto ns = run.put("ns.tum", "1317042505000000000 0 0 0 0 0 0 1\n");
  EXPECT_THAT(failure(ns, truth), AllOf(HasSubstr("ns.tum"), HasSubstr("nanoseconds")));
  const auto ms = run.put("ms.tum", "# t x y z\n1317042505000.5 0 0 0 0 0 0 1\n");
  EXPECT_THAT(failure(truth, ms), AllOf(HasSubstr("ms.tum"), HasSubstr("milliseconds")));
}

TEST(EvaluateFiles, ShortTimesInAnotherUnitAreRecognizedByTheirSpan) {
  const RunFolder run;
  const auto truth = put_tum(run, "truth.tum", sample(2, 10, 100, straight));
  const auto in_ms = put_tum(run, "ms.tum", sample(2000, 10'000, 0.01, straight));
  EXPECT_THAT(failure(in_ms, truth), AllOf(HasSubstr("ms.tum looks like milliseconds")));
  EXPECT_THAT(failure(truth, in_ms), AllOf(HasSubstr("ms.tum looks like milliseconds")));
}

TEST(EvaluateFiles, ATruthThatIsTooSlowSaysSo) {
  const RunFolder run;
  const auto truth = put_tum(run, "truth.tum", sample(0, 100, 0.5, straight));
  const auto estimate = put_tum(run, "estimate.tum", sample(0.15, 90.15, 10, straight));
  EXPECT_THAT(failure(estimate, truth),
              AllOf(HasSubstr("truth.tum has gaps"), HasSubstr("median period is 2.00 s")));
}

/// The true poses of a real drive against themselves, every tenth as the estimate.
TEST(EvaluateFiles, ARealTruthAgreesWithItself) {
  const char* folder = std::getenv("HOLDFAST_DATA");
  const auto data = folder != nullptr ? std::filesystem::path(folder)
                                      : std::filesystem::path(__FILE__)
                                                .parent_path()
                                                .parent_path()
                                                .parent_path()
                                                .parent_path() /
                                            "shared" / "data";
  const auto truth = data / "kitti_0009" / "truth.tum";
  if (!std::filesystem::exists(truth)) GTEST_SKIP() << truth << " is not here";
  const Result<Trajectory> poses = io::read_tum(truth);
  ASSERT_TRUE(poses.ok());
  Trajectory tenth;
  for (std::size_t i = 0; i < poses->size(); i += 10) tenth.push_back((*poses)[i]);
  const Result<Evaluation> e = evaluate(tenth, *poses);
  ASSERT_TRUE(e.ok());
  EXPECT_EQ(e->trans_m.max, 0);
  EXPECT_DOUBLE_EQ(e->coverage.value(), 1);
  EXPECT_NEAR(e->path_m, 61.4, 0.5);
}

}  // namespace
}  // namespace holdfast::evaluation::testing
