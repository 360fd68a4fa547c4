#include "holdfast/preprocess/imu_buffer.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/tolerances.hpp"

namespace holdfast::preprocess {
namespace {

constexpr TimeNs kPeriod = 5'000'000;  // 200 Hz
constexpr TimeNs kStart = 1'700'000'000 * kSecond;

/// Readings that grow linearly with time, so that interpolation is exact: gyro x in rad/s is the
/// time in periods from kStart, accel z ten times that.
ImuSample reading(double periods) {
  ImuSample sample;
  sample.t = kStart + static_cast<TimeNs>(periods * kPeriod);
  sample.gyro_rad_s = {periods, -periods, 1};
  sample.accel_m_s2 = {0, 0, 10 * periods};
  return sample;
}

/// Readings 0 to n - 1.
ImuBuffer filled(int n) {
  ImuBuffer buffer;
  for (int i = 0; i < n; ++i) EXPECT_EQ(buffer.add(reading(i)), ImuBuffer::Verdict::kTaken);
  return buffer;
}

TimeNs at(double periods) { return reading(periods).t; }

void expect_equal(const ImuSample& sample, double periods) {
  const ImuSample expected = reading(periods);
  EXPECT_EQ(sample.t, expected.t);
  // Values of up to 100, interpolated with two products and a sum.
  const double tolerance = 100 * tolerances::kRounding;
  EXPECT_LT((sample.gyro_rad_s - expected.gyro_rad_s).norm(), tolerance);
  EXPECT_LT((sample.accel_m_s2 - expected.accel_m_s2).norm(), tolerance);
}

TEST(ImuBuffer, ASegmentHasInterpolatedReadingsExactlyAtBothEnds) {
  const ImuBuffer buffer = filled(10);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(2.25), at(5.5), segment));
  ASSERT_EQ(segment.samples.size(), 5U);
  const double expected[] = {2.25, 3, 4, 5, 5.5};
  for (std::size_t i = 0; i < 5; ++i) expect_equal(segment.samples[i], expected[i]);
  EXPECT_EQ(segment.held_ns, 0);
  EXPECT_EQ(segment.longest_gap_ns, kPeriod);
}

TEST(ImuBuffer, ASegmentFromReadingToReadingHoldsEachOnce) {
  const ImuBuffer buffer = filled(10);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(3), at(6), segment));
  ASSERT_EQ(segment.samples.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    expect_equal(segment.samples[i], 3.0 + static_cast<double>(i));
}

TEST(ImuBuffer, ASegmentBetweenTwoReadingsHasBothEndsOnly) {
  const ImuBuffer buffer = filled(10);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(3.25), at(3.75), segment));
  ASSERT_EQ(segment.samples.size(), 2U);
  expect_equal(segment.samples[0], 3.25);
  expect_equal(segment.samples[1], 3.75);
  EXPECT_EQ(segment.longest_gap_ns, kPeriod / 2);
}

TEST(ImuBuffer, AnEmptySpanHasOneReadingAndNothingIsHeld) {
  const ImuBuffer buffer = filled(10);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(3.5), at(3.5), segment));
  ASSERT_EQ(segment.samples.size(), 1U);
  expect_equal(segment.samples[0], 3.5);
  EXPECT_EQ(segment.held_ns, 0);
  EXPECT_EQ(segment.longest_gap_ns, 0);
}

TEST(ImuBuffer, TheLastReadingIsHeldAfterTheEndAndSaysForHowLong) {
  const ImuBuffer buffer = filled(4);  // up to 3
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(2), at(6), segment));
  EXPECT_EQ(segment.held_ns, 3 * kPeriod);
  EXPECT_EQ(segment.samples.back().t, at(6));
  EXPECT_EQ(segment.samples.back().gyro_rad_s, reading(3).gyro_rad_s);
  EXPECT_EQ(segment.samples.back().accel_m_s2, reading(3).accel_m_s2);
  EXPECT_EQ(segment.longest_gap_ns, 3 * kPeriod);
}

TEST(ImuBuffer, TheFirstReadingIsHeldBeforeTheBegin) {
  const ImuBuffer buffer = filled(4);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(0) - 2 * kPeriod, at(1), segment));
  EXPECT_EQ(segment.held_ns, 2 * kPeriod);
  EXPECT_EQ(segment.samples.front().t, at(0) - 2 * kPeriod);
  EXPECT_EQ(segment.samples.front().accel_m_s2, reading(0).accel_m_s2);
}

TEST(ImuBuffer, ASpanOutsideOfAllReadingsIsHeldAsAWhole) {
  const ImuBuffer buffer = filled(4);
  ImuSegment segment;
  for (const TimeNs begin : {at(0) - 20 * kPeriod, at(0) + 20 * kPeriod}) {
    ASSERT_TRUE(buffer.segment(begin, begin + 5 * kPeriod, segment));
    EXPECT_EQ(segment.held_ns, 5 * kPeriod);
    ASSERT_EQ(segment.samples.size(), 2U);
    EXPECT_EQ(segment.samples[0].gyro_rad_s, segment.samples[1].gyro_rad_s);
  }
}

TEST(ImuBuffer, AGapInsideIsBridgedAndItsLengthTold) {
  ImuBuffer buffer;
  for (const int i : {0, 1, 2, 9, 10}) buffer.add(reading(i));
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(0.5), at(9.5), segment));
  EXPECT_EQ(segment.longest_gap_ns, 7 * kPeriod);
  EXPECT_EQ(segment.held_ns, 0);
  ASSERT_TRUE(buffer.segment(at(5), at(9.5), segment));  // begins inside of the gap
  expect_equal(segment.samples.front(), 5);
  EXPECT_EQ(segment.longest_gap_ns, 4 * kPeriod);
}

TEST(ImuBuffer, WithoutAnyReadingThereIsNoSegment) {
  const ImuBuffer buffer;
  ImuSegment segment;
  segment.samples.resize(3);
  EXPECT_FALSE(buffer.segment(at(0), at(1), segment));
  EXPECT_TRUE(segment.samples.empty());
  EXPECT_TRUE(buffer.empty());
}

TEST(ImuBuffer, ReadingsThatAreNotLaterAreRefusedAndCounted) {
  ImuBuffer buffer = filled(4);
  EXPECT_EQ(buffer.add(reading(3)), ImuBuffer::Verdict::kOutOfOrder);    // a duplicate
  EXPECT_EQ(buffer.add(reading(1.5)), ImuBuffer::Verdict::kOutOfOrder);  // late
  EXPECT_EQ(buffer.refused_out_of_order(), 2U);
  EXPECT_EQ(buffer.latest(), at(3));
  EXPECT_EQ(buffer.add(reading(4)), ImuBuffer::Verdict::kTaken);
  ImuSegment segment;
  ASSERT_TRUE(buffer.segment(at(1), at(2), segment));
  ASSERT_EQ(segment.samples.size(), 2U);
}

TEST(ImuBuffer, ReadingsThatAreNotFiniteAreRefusedAndCounted) {
  ImuBuffer buffer = filled(2);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    ImuSample gyro = reading(2);
    gyro.gyro_rad_s.y() = bad;
    ImuSample accel = reading(2);
    accel.accel_m_s2.x() = bad;
    EXPECT_EQ(buffer.add(gyro), ImuBuffer::Verdict::kNotFinite);
    EXPECT_EQ(buffer.add(accel), ImuBuffer::Verdict::kNotFinite);
  }
  EXPECT_EQ(buffer.refused_not_finite(), 6U);
  EXPECT_EQ(buffer.refused_out_of_order(), 0U);
  EXPECT_EQ(buffer.latest(), at(1));
  EXPECT_EQ(buffer.add(reading(2)), ImuBuffer::Verdict::kTaken);
}

TEST(ImuBuffer, WhatIsForgottenIsNotNeededByAnyLaterSegment) {
  const ImuBuffer whole = filled(20);
  ImuBuffer dropped = filled(20);
  dropped.drop_before(at(7.5));
  ImuSegment expected;
  ImuSegment segment;
  ASSERT_TRUE(whole.segment(at(7.5), at(12.25), expected));
  ASSERT_TRUE(dropped.segment(at(7.5), at(12.25), segment));
  ASSERT_EQ(segment.samples.size(), expected.samples.size());
  for (std::size_t i = 0; i < segment.samples.size(); ++i) {
    EXPECT_EQ(segment.samples[i].t, expected.samples[i].t);
    EXPECT_EQ(segment.samples[i].gyro_rad_s, expected.samples[i].gyro_rad_s);
  }
  EXPECT_EQ(segment.held_ns, 0);
  ASSERT_TRUE(
      dropped.segment(at(6.5), at(8), segment));  // earlier: reading 7 is the first one left
  EXPECT_EQ(segment.held_ns, kPeriod / 2);
}

TEST(ImuBuffer, TheLastReadingIsNeverForgotten) {
  ImuBuffer buffer = filled(5);
  buffer.drop_before(at(1000));
  EXPECT_FALSE(buffer.empty());
  EXPECT_EQ(buffer.latest(), at(4));
  EXPECT_EQ(buffer.add(reading(4)), ImuBuffer::Verdict::kOutOfOrder);
}

}  // namespace
}  // namespace holdfast::preprocess
