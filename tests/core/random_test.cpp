#include "holdfast/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/tolerances.hpp"

namespace holdfast {
namespace {

using tolerances::mean_error;

constexpr int kMany = 1'000'000;

std::vector<std::uint64_t> first_four(RandomStream stream) {
  std::vector<std::uint64_t> out;
  for (int i = 0; i < 4; ++i) out.push_back(stream.next_u64());
  return out;
}

// From a second implementation in Python, checked against the published vectors of xoshiro256++
// (state 1 2 3 4) and SplitMix64 (seed 0).
TEST(RandomStream, GivesTheKnownNumbersOfItsSeedAndName) {
  EXPECT_EQ(first_four({1, "lidar.range"}),
            (std::vector<std::uint64_t>{0xf374c23b78f13c97, 0xffdde4859b1a5e68, 0xe55896b23999dae7,
                                        0xb30f62cb5202de43}));
  EXPECT_EQ(first_four({1, "imu.gyro"}),
            (std::vector<std::uint64_t>{0x18d6f79cf4724c5e, 0xb8c5e29f693e069b, 0xe7fa5348c463a256,
                                        0xe57cd841c4cb627a}));
  EXPECT_EQ(first_four({2, "lidar.range"}),
            (std::vector<std::uint64_t>{0x990f1b211a4d256f, 0x40803b3271bd927d, 0x72d0996176e5ae37,
                                        0xf9ed8bafdae078a1}));
  EXPECT_EQ(first_four({0, ""}),
            (std::vector<std::uint64_t>{0x96bb3c9cab98ed3f, 0x65b64fbc9a770e81, 0xed86fb2d91de1ae1,
                                        0xc597f5e135156f81}));
}

// From the same second implementation; logarithms may differ in their last bit.
TEST(RandomStream, GivesTheKnownNormalNumbers) {
  RandomStream random(1, "lidar.range");
  for (const double x :
       {0.6197244581440959, 0.31222917658911387, 0.9882031846866495, -1.0210048038461295}) {
    EXPECT_NEAR(random.normal(), x, tolerances::kRounding);
  }
}

TEST(RandomStream, ANewConsumerDoesNotShiftAnOldOne) {
  RandomStream alone(5, "old");
  RandomStream beside(5, "old");
  RandomStream other(5, "new");
  for (int i = 0; i < 100; ++i) {
    other.normal();
    EXPECT_EQ(alone.normal(), beside.normal());
  }
}

TEST(RandomStream, StreamsOfDifferentNamesAndSeedsAreUncorrelated) {
  for (const auto& [seed, name] :
       {std::pair{9, "imu.gyro.y"}, std::pair{10, "imu.gyro.x"}, std::pair{9, "imu.gyro.x "}}) {
    RandomStream a(9, "imu.gyro.x");
    RandomStream b(static_cast<std::uint64_t>(seed), name);
    double sum = 0;
    for (int i = 0; i < kMany; ++i) sum += a.normal() * b.normal();
    EXPECT_NEAR(sum / kMany, 0, mean_error(1, kMany)) << seed << " " << name;
  }
}

TEST(RandomStream, UniformNumbersHaveTheMomentsOfTheUniformDistribution) {
  RandomStream random(3, "uniform");
  double sum = 0;
  double squares = 0;
  double products = 0;
  double last = 0.5;
  for (int i = 0; i < kMany; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
    products += (u - 0.5) * (last - 0.5);
    last = u;
  }
  EXPECT_NEAR(sum / kMany, 1.0 / 2, mean_error(std::sqrt(1.0 / 12), kMany));
  EXPECT_NEAR(squares / kMany, 1.0 / 3, mean_error(std::sqrt(4.0 / 45), kMany));
  EXPECT_NEAR(products / kMany, 0, mean_error(1.0 / 12, kMany));
}

TEST(RandomStream, UniformOfAnIntervalStaysInsideAndFillsIt) {
  RandomStream random(3, "interval");
  double low = 5;
  double high = -3;
  for (int i = 0; i < 10'000; ++i) {
    const double u = random.uniform(-3, 5);
    ASSERT_GE(u, -3);
    ASSERT_LT(u, 5);
    low = std::min(low, u);
    high = std::max(high, u);
  }
  // 10 000 values all miss an end of 0.2 % of the interval once in 5e8 seeds: 0.998^10000.
  EXPECT_LT(low, -3 + 0.002 * 8);
  EXPECT_GT(high, 5 - 0.002 * 8);
}

// The variance of x^k for a standard normal x: (2k - 1)!! - ((k - 1)!!)^2 for even k, (2k - 1)!!
// for odd k.
TEST(RandomStream, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  RandomStream random(3, "normal");
  double sums[4] = {};
  for (int i = 0; i < kMany; ++i) {
    const double x = random.normal();
    sums[0] += x;
    sums[1] += x * x;
    sums[2] += x * x * x;
    sums[3] += x * x * x * x;
  }
  EXPECT_NEAR(sums[0] / kMany, 0, mean_error(1, kMany));
  EXPECT_NEAR(sums[1] / kMany, 1, mean_error(std::sqrt(2.0), kMany));
  EXPECT_NEAR(sums[2] / kMany, 0, mean_error(std::sqrt(15.0), kMany));
  EXPECT_NEAR(sums[3] / kMany, 3, mean_error(std::sqrt(96.0), kMany));
}

TEST(RandomStream, NormalNumbersTakeMeanAndStandardDeviation) {
  RandomStream standard(4, "n");
  RandomStream shifted(4, "n");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(shifted.normal(2, 0.5), 2 + 0.5 * standard.normal());
}

TEST(RandomStream, BelowGivesEveryNumberEquallyOften) {
  RandomStream random(3, "below");
  constexpr int kCells = 10;
  int counts[kCells] = {};
  for (int i = 0; i < kMany; ++i) ++counts[random.below(kCells)];
  const double share = 1.0 / kCells;
  for (const int count : counts) {
    EXPECT_NEAR(count / double{kMany}, share, mean_error(std::sqrt(share * (1 - share)), kMany));
  }
}

}  // namespace
}  // namespace holdfast
