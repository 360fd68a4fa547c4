#include "holdfast/relocalization/judging/prospects.hpp"

#include <gtest/gtest.h>

namespace holdfast::relocalization {
namespace {

SE3 at(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

Prospect refined(double from_x, double to_x, double share) {
  Prospect prospect;
  prospect.T_map_body = at(from_x);
  Refined to;
  to.T_map_body = at(to_x);
  to.agreeing_share = share;
  to.usable = true;
  prospect.take(to);
  return prospect;
}

TEST(Prospects, TheBestAreKeptAndCopiesLeftOut) {
  std::vector<Prospect> prospects = {refined(0, 0, 0.5), refined(5, 5, 0.9), refined(5.5, 5.1, 0.8),
                                     refined(9, 9, 0.7)};
  keep_best(2, prospects);
  ASSERT_EQ(prospects.size(), 2U);
  EXPECT_EQ(prospects[0].share, 0.9);
  EXPECT_EQ(prospects[1].share, 0.7);
}

TEST(Prospects, AModeThatWasDrawnFarAwayIsNone) {
  EXPECT_EQ(refined(2, 0, 0.9).share, 0);
  EXPECT_EQ(refined(1, 0, 0.9).share, 0.9);
}

// Of two modes that were drawn to one pose, the farther was kept at times, and then refused for
// having come so far: the true pose was lost in a garage, and one alike taken for it.
TEST(Prospects, ACopyFromFarDoesNotReplaceOneFromNear) {
  std::vector<Prospect> prospects = {refined(0.2, 0, 0.8), refined(2, 0, 0.9)};
  keep_best(5, prospects);
  ASSERT_EQ(prospects.size(), 1U);
  EXPECT_TRUE(prospects[0].leads_to(at(0)));
}

}  // namespace
}  // namespace holdfast::relocalization
