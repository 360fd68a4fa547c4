#include "holdfast/core/time.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "holdfast/core/random.hpp"

namespace holdfast {
namespace {

constexpr TimeNs kUntouched = -7;

TimeNs parsed(const std::string& text) {
  TimeNs t = kUntouched;
  EXPECT_TRUE(parse_seconds(text, t)) << text;
  return t;
}

TEST(FormatSeconds, WritesNineDigitsWithoutRounding) {
  EXPECT_EQ(format_seconds(0), "0.000000000");
  EXPECT_EQ(format_seconds(1'317'042'504'599'424'001), "1317042504.599424001");
  EXPECT_EQ(format_seconds(999'999'999), "0.999999999");
  EXPECT_EQ(format_seconds(-1), "-0.000000001");
  EXPECT_EQ(format_seconds(-1'500'000'000), "-1.500000000");
  EXPECT_EQ(format_seconds(std::numeric_limits<TimeNs>::max()), "9223372036.854775807");
  EXPECT_EQ(format_seconds(std::numeric_limits<TimeNs>::min()), "-9223372036.854775808");
}

TEST(ParseSeconds, ReadsToTheNanosecond) {
  EXPECT_EQ(parsed("1317042504.599424001"), 1'317'042'504'599'424'001);
  EXPECT_EQ(parsed("12"), 12 * kSecond);
  EXPECT_EQ(parsed("0.5"), kSecond / 2);
  EXPECT_EQ(parsed("-0.000000001"), -1);
  EXPECT_EQ(parsed("-3.25"), -3'250'000'000);
  EXPECT_EQ(parsed("0012.3"), 12'300'000'000);
}

TEST(ParseSeconds, DropsDigitsAfterTheNinth) {
  EXPECT_EQ(parsed("1.9999999999"), 1'999'999'999);
  EXPECT_EQ(parsed("-1.9999999999"), -1'999'999'999);
}

TEST(ParseSeconds, ReadsBackWhatFormatSecondsWrites) {
  RandomStream random(6, "times");
  for (int i = 0; i < 20'000; ++i) {
    const auto t = static_cast<TimeNs>(random.next_u64() >> (1 + random.below(60)));
    EXPECT_EQ(parsed(format_seconds(t)), t);
    EXPECT_EQ(parsed(format_seconds(-t)), -t);
  }
  EXPECT_EQ(parsed("9223372036.854775807"), std::numeric_limits<TimeNs>::max());
}

TEST(ParseSeconds, ReadsScientificNotation) {
  EXPECT_EQ(parsed("1.5e3"), 1500 * kSecond);
  EXPECT_EQ(parsed("-25E-2"), -kSecond / 4);
}

TEST(ParseSeconds, RefusesWhatIsNoNumberAndLeavesTheTimeAlone) {
  for (const char* text : {"", "-", ".", "abc", "1.2.3", "1,5", "nan", "inf", "-inf", "1.5x", "1 2",
                           "1.5 ", "1e400", "--1", "1e", "99999999999", "1e11"}) {
    TimeNs t = kUntouched;
    EXPECT_FALSE(parse_seconds(text, t)) << text;
    EXPECT_EQ(t, kUntouched) << text;
  }
}

TEST(FromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1.0000000004), kSecond);
  EXPECT_EQ(from_seconds(1.0000000006), kSecond + 1);
  EXPECT_EQ(from_seconds(-1.0000000006), -kSecond - 1);
  EXPECT_EQ(from_seconds(0.1), kSecond / 10);
}

TEST(ToSeconds, OfADurationIsExactToAFractionOfANanosecond) {
  for (const TimeNs t : {TimeNs{1}, TimeNs{100'000'001}, 3600 * kSecond + 1}) {
    EXPECT_EQ(from_seconds(to_seconds(t)), t);
    EXPECT_EQ(from_seconds(to_seconds(-t)), -t);
  }
}

}  // namespace
}  // namespace holdfast
