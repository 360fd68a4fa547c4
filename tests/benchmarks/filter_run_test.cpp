#include "benchmarks/drives/filter_run.hpp"

#include <gtest/gtest.h>

#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/yardsticks/log_reading.hpp"
#include "holdfast/io/log_file.hpp"

namespace holdfast::benchmarks {
namespace {

const DriveSpec kSpec{"box", 1, 4.0, 1};

/// A short drive in an empty room, recorded.
class RecordedDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    auto drive = survey_drive(kSpec, scratch_->path());
    ASSERT_TRUE(drive) << drive.error().message;
    drive_ = std::move(*drive);
    const auto recorded = record_bag(*drive_.simulation, bag_);
    ASSERT_TRUE(recorded) << recorded.error().message;
  }

  std::unique_ptr<io::LogReader> log() const {
    auto log = io::open_log(bag_, {});
    EXPECT_TRUE(log) << log.error().message;
    return std::move(*log);
  }

  Result<ScratchFolder> scratch_ = ScratchFolder::create();
  std::filesystem::path bag_ = *scratch_ / "run.bag";
  SurveyedDrive drive_;
};

TEST_F(RecordedDrive, IsFilteredBitForBitAsTheLocalizerDoes) {
  drive_.config.method = "map_filter";
  const auto steps = localize(*log(), drive_.config, drive_.map_dir, drive_.initial_pose);
  const auto scans = run_filter(*log(), drive_);
  ASSERT_TRUE(steps && scans);
  ASSERT_EQ(steps->size(), scans->size());
  ASSERT_GE(steps->size(), 38U);
  for (std::size_t i = 0; i < steps->size(); ++i) {
    const StepReport& a = (*steps)[i];
    const StepReport& b = (*scans)[i].report;
    EXPECT_EQ(a.pose_time, b.pose_time);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.T_map_body.translation, b.T_map_body.translation);
    EXPECT_EQ(a.T_map_body.rotation.coeffs(), b.T_map_body.rotation.coeffs());
  }
}

TEST_F(RecordedDrive, IsPredictedFromTheStateBeforeTheScan) {
  const auto scans = run_filter(*log(), drive_);
  ASSERT_TRUE(scans) << scans.error().message;
  EXPECT_EQ(scans->front().points.size(), 0U);
  double worst_m = 0;
  // The first seconds, in which velocity and biases settle, are left out.
  for (std::size_t i = 20; i < scans->size(); ++i) {
    const FilteredScan& scan = (*scans)[i];
    const double off_m =
        (scan.predicted.T_map_body.translation - scan.report.T_map_body.translation).norm();
    EXPECT_GT(off_m, 0) << "the prediction is not the result";
    worst_m = std::max(worst_m, off_m);
    EXPECT_EQ(scan.points.size(), static_cast<std::size_t>(drive_.config.preprocess.max_points));
  }
  EXPECT_LT(worst_m, 0.02);
}

TEST_F(RecordedDrive, IsRegisteredAgainByTheKdTreeFromTheSamePredictions) {
  const auto scans = run_filter(*log(), drive_);
  ASSERT_TRUE(scans) << scans.error().message;
  KdTreeRegistration tree(drive_.simulation->survey_map().points);
  for (std::size_t i = 1; i < scans->size(); ++i) {
    const FilteredScan& scan = (*scans)[i];
    const Registration found =
        tree.align(scan.points, drive_.config.T_body_lidar.translation, scan.predicted);
    const SE3 truth = drive_.simulation->truth_at(scan.report.pose_time);
    EXPECT_LT((found.T_map_body.translation - truth.translation).norm(), 0.02) << "scan " << i;
    EXPECT_GT(found.pairs, 0.8 * static_cast<double>(scan.points.size())) << "scan " << i;
  }
}

TEST_F(RecordedDrive, IsReadWithOneTimeAScan) {
  const auto times = time_reading(bag_);
  ASSERT_TRUE(times) << times.error().message;
  EXPECT_EQ(times->size(), drive_.simulation->scan_count());
  for (const double ms : *times) EXPECT_GT(ms, 0);
}

TEST(Reading, OfAMissingLogIsAnErrorThatNamesIt) {
  const auto times = time_reading("/nowhere/run.bag");
  ASSERT_FALSE(times);
  EXPECT_NE(times.error().message.find("/nowhere/run.bag"), std::string::npos);
}

TEST(Judgement, CountsAScanWithoutAClaimAgainstTheRun) {
  std::vector<StepReport> steps(100);
  evaluation::Trajectory truth;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto t = static_cast<TimeNs>(i) * kSecond / 10;
    steps[i].stamp = steps[i].pose_time = t;
    steps[i].state = i % 2 == 0 ? State::kTracking : State::kLost;
    truth.push_back({t, {}});
  }
  const auto e = judge(steps, truth);
  ASSERT_TRUE(e) << e.error().message;
  EXPECT_EQ(e->scans, 100U);
  EXPECT_EQ(e->claimed, 50U);
  EXPECT_NEAR(e->coverage.value(), 0.5, 0.01);
}

}  // namespace
}  // namespace holdfast::benchmarks
