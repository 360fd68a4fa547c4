#include "holdfast/io/tum_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct TumFile : ::testing::Test {
  TemporaryFolder folder;

  std::string error_of(std::string_view text) {
    const auto poses = read_tum(folder.put("t.tum", text));
    EXPECT_FALSE(poses) << text;
    return poses ? "" : poses.error().message;
  }
};

TEST_F(TumFile, ATrajectoryIsReadToTheNanosecond) {
  const auto poses = read_tum(folder.put("t.tum",
                                         "# t x y z qx qy qz qw\n"
                                         "1317042504.599423885 1 -2.5 3e1 0 0 0 1\n"
                                         "\n"
                                         "   \t\r\n"
                                         "1317042504.599423886\t+4 5 6 0 0 3 -4 # turned\r\n"));
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ((*poses)[0].t, 1317042504599423885);
  EXPECT_EQ((*poses)[0].T_map_body.translation, Eigen::Vector3d(1, -2.5, 30));
  EXPECT_EQ((*poses)[1].t, 1317042504599423886);
  EXPECT_EQ((*poses)[1].T_map_body.translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ((*poses)[1].T_map_body.rotation.coeffs(), Eigen::Vector4d(0, 0, 0.6, -0.8));
}

TEST_F(TumFile, ALastLineWithoutItsEndIsRead) {
  const auto poses = read_tum(folder.put("t.tum", "1 1 2 3 0 0 0 1\n2 1 2 3 0 0 0 1"));
  ASSERT_TRUE(poses);
  EXPECT_EQ(poses->size(), 2U);
}

TEST_F(TumFile, ATeleportKeepsBothPosesOfItsTime) {
  const auto poses = read_tum(folder.put("t.tum", "1 0 0 0 0 0 0 1\n1 9 9 9 0 0 0 1\n"));
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ((*poses)[0].t, (*poses)[1].t);
}

TEST_F(TumFile, AFileWithoutPosesIsAnEmptyTrajectory) {
  const auto poses = read_tum(folder.put("t.tum", "# nothing\n"));
  ASSERT_TRUE(poses);
  EXPECT_TRUE(poses->empty());
}

TEST_F(TumFile, WhatWasWrittenIsReadAgain) {
  std::vector<StampedPose> poses(2);
  poses[0].t = 1;
  poses[0].T_map_body.translation = {0.123456789, -1e-9, 12345.678901234};
  poses[1].t = 1700000000123456789;
  poses[1].T_map_body.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  const auto path = folder / "t.tum";
  ASSERT_TRUE(write_tum(path, poses));
  const auto again = read_tum(path);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->size(), 2U);
  constexpr double kHalfDigit = 0.5e-9 + 1e-12;  // nine decimals, and the rounding of 12345.68
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*again)[i].t, poses[i].t);
    EXPECT_LE(((*again)[i].T_map_body.translation - poses[i].T_map_body.translation)
                  .lpNorm<Eigen::Infinity>(),
              kHalfDigit);
    EXPECT_EQ((*again)[i].T_map_body.rotation.coeffs(), poses[i].T_map_body.rotation.coeffs());
  }
  const auto text = read_bytes(path);
  ASSERT_TRUE(write_tum(path, *again));
  EXPECT_EQ(read_bytes(path), text);
  EXPECT_THAT(folder.names(), ElementsAre("t.tum"));
}

TEST_F(TumFile, ALineHasNineDecimals) {
  StampedPose pose;
  pose.t = 1317042504599423885;
  pose.T_map_body.translation = {1, -0.5, 0};
  EXPECT_EQ(format_tum_line(pose),
            "1317042504.599423885 1.000000000 -0.500000000 0.000000000 0.000000000 0.000000000 "
            "0.000000000 1.000000000");
}

TEST_F(TumFile, ErrorsNameFileLineAndWhatWasFound) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(error_of(good + "2 0 0 0 0 0 1\n"),
              AllOf(HasSubstr("t.tum: line 2: 7 values"), HasSubstr("expected the 8")));
  EXPECT_THAT(error_of(good + "2 0 0 0 0 0 0 1 9\n"), HasSubstr("line 2: 9 values"));
  EXPECT_THAT(error_of(good + "#\n2 0 0 zero 0 0 0 1\n"),
              HasSubstr("line 3: 'zero' is not a finite number"));
  EXPECT_THAT(error_of("noon 0 0 0 0 0 0 1\n"), HasSubstr("line 1: time 'noon' is not a number"));
  EXPECT_THAT(error_of("nan 0 0 0 0 0 0 1\n"), HasSubstr("line 1: time 'nan' is not a number"));
  for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999", "0x10", "1,5"}) {
    EXPECT_THAT(error_of(good + "2 0 " + value + " 0 0 0 0 1\n"),
                HasSubstr(std::string("line 2: '") + value + "' is not a finite number"));
  }
  EXPECT_THAT(error_of(good + "2 0 0 0 0 0 0 0\n"), HasSubstr("line 2: the quaternion is zero"));
  EXPECT_THAT(error_of(good + "0.999999999 0 0 0 0 0 0 1\n"),
              AllOf(HasSubstr("line 2: time 0.999999999 runs back"), HasSubstr("1.000000000")));
}

TEST_F(TumFile, AMissingFileIsAnErrorThatNamesIt) {
  const auto poses = read_tum(folder / "none.tum");
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().message, HasSubstr("none.tum: cannot be opened"));
  const auto of_folder = read_tum(folder.path());
  ASSERT_FALSE(of_folder);
  EXPECT_THAT(of_folder.error().message, HasSubstr("is not a regular file"));
}

}  // namespace
}  // namespace holdfast::io::testing
