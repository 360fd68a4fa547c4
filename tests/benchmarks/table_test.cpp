#include "benchmarks/harness/table.hpp"

#include <gtest/gtest.h>

namespace holdfast::benchmarks {
namespace {

TEST(Table, HasEquallyWideColumnsWithFiguresToTheRight) {
  Table table({"what", "time"});
  table.add_row({"step", "0.5 ms"});
  table.add_row({"registration", "12 ms"});
  EXPECT_EQ(table.markdown(),
            "| what         |   time |\n"
            "|--------------|-------:|\n"
            "| step         | 0.5 ms |\n"
            "| registration |  12 ms |\n");
}

TEST(Table, KeepsCellsThatHoldItsOwnSigns) {
  Table table({"a", "b"});
  table.add_row({"x|y", "one\ntwo"});
  EXPECT_EQ(table.markdown(),
            "| a    |       b |\n"
            "|------|--------:|\n"
            "| x\\|y | one two |\n");
}

TEST(Table, CountsCharactersAndNotBytes) {
  Table table({"a", "b"});
  table.add_row({"\xc2\xb5s", "1"});
  EXPECT_EQ(table.markdown(),
            "| a  | b |\n"
            "|----|--:|\n"
            "| \xc2\xb5s | 1 |\n");
}

}  // namespace
}  // namespace holdfast::benchmarks
