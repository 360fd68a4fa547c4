#include "benchmarks/scores/scan_census.hpp"

#include <gtest/gtest.h>

#include "benchmarks/harness/scratch_folder.hpp"
#include "evaluation/statistics.hpp"

namespace holdfast::benchmarks {
namespace {

TEST(ScanCounts, TooFewIsLessThanTenEdgesOrTwentyPlanes) {
  ScanCounts counts;
  counts.returns = {1000, 1000, 1000, 1000};
  counts.edge_matches = {9, 10, 400, 9};
  counts.plane_matches = {500, 20, 19, 19};
  EXPECT_EQ(counts.few_edges(), 0.5);
  EXPECT_EQ(counts.few_planes(), 0.5);
  EXPECT_EQ(counts.few_of_either(), 0.75) << "10 edges and 20 planes are enough";
}

/// All scans of a second in the office: rays that nobody stops come back, and most match.
TEST(ScanCensus, CountsAllReturnsAndThoseFromPeople) {
  auto scratch = ScratchFolder::create();
  ASSERT_TRUE(scratch);
  auto drive = survey_drive({"office", 1, 1}, scratch->path());
  ASSERT_TRUE(drive) << drive.error().message;
  const auto census = ScanCensus::create(*drive);
  ASSERT_TRUE(census) << census.error().message;
  features::FeatureConfig config;
  config.smoothness = "log";
  features::FeatureExtractor extractor(config, drive->simulation->options().lidar.range_sigma_m);
  features::Features found;
  ScanCounts counts;
  for (auto event = drive->simulation->next(); event->has_value();
       event = drive->simulation->next()) {
    const Scan* scan = std::get_if<Scan>(&**event);
    if (scan == nullptr) continue;
    auto truth = drive->simulation->true_geometry(*scan);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i].moving = i % 4 == 0;
    extractor.extract(*scan, found);
    census->add(*scan, found, truth, counts);
    EXPECT_EQ(counts.returns.back(), static_cast<double>(scan->points.size()));
    EXPECT_LE(counts.edge_matches.back(), static_cast<double>(found.edges.size()));
    EXPECT_NEAR(counts.occluded.back(), 0.25, 1.0 / static_cast<double>(scan->points.size()));
  }
  ASSERT_EQ(counts.scans(), drive->simulation->scan_count());
  EXPECT_EQ(counts.few_of_either(), 0) << "an office is full of planes";
}

}  // namespace
}  // namespace holdfast::benchmarks
