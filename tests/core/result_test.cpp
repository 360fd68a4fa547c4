#include "holdfast/core/result.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace holdfast {
namespace {

Result<int> half(int n) {
  if (n % 2 != 0) return Error{"expected an even number, found " + std::to_string(n)};
  return n / 2;
}

TEST(Result, HoldsAValueOrTheReason) {
  const Result<int> good = half(8);
  ASSERT_TRUE(good.ok());
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 4);
  EXPECT_EQ(good.value(), 4);
  const Result<int> bad = half(7);
  EXPECT_FALSE(bad.ok());
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "expected an even number, found 7");
}

TEST(Result, HandsOutWhatCanOnlyBeMoved) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  ASSERT_TRUE(result);
  EXPECT_EQ(**result, 3);
  const std::unique_ptr<int> taken = std::move(result).value();
  EXPECT_EQ(*taken, 3);
}

TEST(Result, LetsTheValueBeChangedInPlace) {
  Result<std::string> result = std::string("ab");
  result->push_back('c');
  *result += "d";
  EXPECT_EQ(result.value(), "abcd");
}

TEST(Status, IsDoneOrAnError) {
  const Status done = Done{};
  EXPECT_TRUE(done);
  const Status failed = Error{"no such file"};
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "no such file");
}

}  // namespace
}  // namespace holdfast
