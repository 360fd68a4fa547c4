#include "holdfast/relocalization/wide/lane_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "holdfast/core/random.hpp"

namespace holdfast::relocalization {
namespace {

TEST(LaneCounter, CountsEachLaneAsOneWouldByHand) {
  RandomStream random(1, "lanes");
  LaneCounter counter;
  std::array<int, 64> expected{};
  for (int batch = 0; batch < 40; ++batch) {
    std::uint64_t words[8];
    for (std::uint64_t& word : words) {
      word = random.next_u64() | random.next_u64();
      for (int lane = 0; lane < 64; ++lane) expected[lane] += static_cast<int>(word >> lane & 1U);
    }
    counter.add8(words);
  }
  for (int lane = 0; lane < 64; ++lane) EXPECT_EQ(counter.count(lane), expected[lane]);
  EXPECT_EQ(counter.largest(~std::uint64_t{0}),
            *std::max_element(expected.begin(), expected.end()));
  EXPECT_EQ(counter.largest(std::uint64_t{1} << 7), expected[7]);
  for (int lane = 0; lane < 64; ++lane) {
    EXPECT_EQ(counter.at_least(expected[7]) >> lane & 1U, expected[lane] >= expected[7] ? 1U : 0U);
  }
}

}  // namespace
}  // namespace holdfast::relocalization
