#include <gtest/gtest.h>

#include "tests/io/config_example.hpp"

namespace holdfast::io::testing {
namespace {

struct ReadExample : ::testing::Test {
  Status read(std::string_view text) {
    auto fields = fields_of(config);
    return read_config_file(ExampleFile(text).path(), fields);
  }
  ExampleConfig config;
};

TEST_F(ReadExample, EveryTypeIsReadIntoItsField) {
  const Status status = read(
      "T_body_lidar: [1, -2.5, 3e-1, 0, 0, 1, 0]\n"
      "filter:\n"
      "  range_sigma_m: 0.03\n"
      "  iterations: +7\n"
      "  use_rings: false\n"
      "  loss: 'cauchy'\n"
      "  voxels_m: [0.25, 2]\n"
      "deskew: {max_gap_s: 0, topic: \"/a b:c\"}\n");
  ASSERT_TRUE(status) << status.error().message;
  EXPECT_EQ(config.T_body_lidar.translation, Eigen::Vector3d(1, -2.5, 0.3));
  EXPECT_EQ(config.T_body_lidar.rotation.coeffs(), Eigen::Vector4d(0, 0, 1, 0));
  EXPECT_TRUE(config.has_extrinsic);
  EXPECT_EQ(config.filter.range_sigma_m, 0.03);
  EXPECT_EQ(config.filter.iterations, 7);
  EXPECT_FALSE(config.filter.use_rings);
  EXPECT_EQ(config.filter.loss, "cauchy");
  EXPECT_EQ(config.filter.voxels_m, (std::vector<double>{0.25, 2}));
  EXPECT_EQ(config.deskew.max_gap_s, 0);
  EXPECT_EQ(config.deskew.topic, "/a b:c");
}

TEST_F(ReadExample, KeysThatAreAbsentKeepTheirValues) {
  for (const char* text : {"", "# only a comment\n", "filter:\n", "filter: {}\n"}) {
    config.filter.iterations = 9;
    ASSERT_TRUE(read(text)) << text;
    EXPECT_EQ(config.filter.iterations, 9);
    EXPECT_FALSE(config.has_extrinsic);
  }
}

TEST_F(ReadExample, AnErrorChangesNoField) {
  ASSERT_FALSE(read("filter:\n  iterations: 7\n  range_sigma_m: 5\n"));
  EXPECT_EQ(config.filter.iterations, 4);
}

TEST_F(ReadExample, AQuaternionIsNormalisedAndOneOfUnitNormKeepsItsBits) {
  ASSERT_TRUE(read("T_body_lidar: [0, 0, 0, 0, 0, 3e200, 4e200]\n"));
  EXPECT_TRUE(
      config.T_body_lidar.rotation.coeffs().isApprox(Eigen::Vector4d(0, 0, 0.6, 0.8), 1e-15));
  ASSERT_TRUE(read("T_body_lidar: [0, 0, 0, 0.1, 0.2, 0.3, 0.4]\n"));
  EXPECT_NEAR(config.T_body_lidar.rotation.norm(), 1.0, 1e-15);
}

TEST(ReadConfig, ATypeErrorNamesFileLineKeyExpectedAndFound) {
  EXPECT_EQ(reading_error("filter:\n  loss: none\n  range_sigma_m: wide\n"),
            "FILE:3: filter.range_sigma_m: expected a finite number from 0.001 to 1, found 'wide'");
  EXPECT_EQ(reading_error("filter: {iterations: 2.0}\n"),
            "FILE:1: filter.iterations: expected a whole number from 1 to 20, found '2.0'");
  EXPECT_EQ(reading_error("filter:\n  use_rings: yes\n"),
            "FILE:2: filter.use_rings: expected true or false, found 'yes'");
  EXPECT_EQ(reading_error("filter:\n  loss: [huber]\n"),
            "FILE:2: filter.loss: expected text, found a list of 1 values");
  EXPECT_EQ(reading_error("filter:\n  voxels_m: 3\n"),
            "FILE:2: filter.voxels_m: expected a list of numbers, found '3'");
  EXPECT_EQ(reading_error("\n\ndeskew:\n  max_gap_s:\n"),
            "FILE:4: deskew.max_gap_s: expected a finite number >= 0, found nothing");
  EXPECT_EQ(reading_error("deskew: fast\n"),
            "FILE:1: deskew: expected a block of keys, found 'fast'");
  EXPECT_EQ(reading_error("- 1\n- 2\n"),
            "FILE:1: expected keys with values, found a list of 2 values");
}

TEST(ReadConfig, ANumberInQuotesIsText) {
  EXPECT_EQ(reading_error("deskew: {max_gap_s: \"0.5\"}\n"),
            "FILE:1: deskew.max_gap_s: expected a finite number >= 0, found '0.5'");
}

TEST(ReadConfig, AValueOutOfRangeIsRefusedAndTheLimitsAreNot) {
  EXPECT_EQ(reading_error("filter: {range_sigma_m: 1.0000001}\n"),
            "FILE:1: filter.range_sigma_m: expected a finite number from 0.001 to 1, found "
            "'1.0000001'");
  EXPECT_EQ(reading_error("filter: {range_sigma_m: 1, iterations: 20}\n"), "");
  EXPECT_EQ(reading_error("filter: {range_sigma_m: 0.001, iterations: 1}\n"), "");
  EXPECT_EQ(reading_error("filter: {iterations: 99999999999999}\n"),
            "FILE:1: filter.iterations: expected a whole number from 1 to 20, found "
            "'99999999999999'");
  EXPECT_EQ(reading_error("filter: {loss: tukey}\n"),
            "FILE:1: filter.loss: expected one of none|huber|cauchy, found 'tukey'");
  EXPECT_EQ(reading_error("filter: {voxels_m: [1, 20]}\n"),
            "FILE:1: filter.voxels_m: value 2: expected a finite number from 0.05 to 10, found "
            "'20'");
}

TEST(ReadConfig, NanAndInfinityAreRefused) {
  for (const char* word : {"nan", ".nan", ".NaN", "inf", "-.inf", "1e999"}) {
    const std::string message = reading_error("deskew: {max_gap_s: " + std::string(word) + "}\n");
    EXPECT_EQ(message, "FILE:1: deskew.max_gap_s: expected a finite number >= 0, found '" +
                           std::string(word) + "'");
  }
  EXPECT_EQ(reading_error("T_body_lidar: [0, 0, .nan, 0, 0, 0, 1]\n"),
            "FILE:1: T_body_lidar: value 3: expected a finite number, found '.nan'");
}

TEST(ReadConfig, AnUnknownKeyNamesTheNearestKnownKey) {
  EXPECT_EQ(reading_error("filter:\n  range_sgma_m: 0.1\n"),
            "FILE:2: unknown key 'filter.range_sgma_m': the nearest known key is "
            "'filter.range_sigma_m'");
  EXPECT_EQ(reading_error("T_lidar_body: [0, 0, 0, 0, 0, 0, 1]\n"),
            "FILE:1: unknown key 'T_lidar_body': the nearest known key is 'T_body_lidar'");
  EXPECT_EQ(reading_error("desckew: {max_gap_s: 1}\n"),
            "FILE:1: unknown key 'desckew.max_gap_s': the nearest known key is "
            "'deskew.max_gap_s'");
}

TEST(ReadConfig, AKeyInTheWrongModuleNamesTheRightOne) {
  EXPECT_EQ(reading_error("filter: {max_gap_s: 1}\n"),
            "FILE:1: unknown key 'filter.max_gap_s': the nearest known key is "
            "'deskew.max_gap_s'");
  EXPECT_EQ(reading_error("lidar: {T_body_lidar: 1}\n"),
            "FILE:1: unknown key 'lidar.T_body_lidar': the nearest known key is 'T_body_lidar'");
}

TEST(ReadConfig, AThirdLevelIsRefused) {
  EXPECT_EQ(reading_error("filter: {iterations: {first: 1}}\n"),
            "FILE:1: filter.iterations: expected a whole number from 1 to 20, found a block of "
            "keys");
  EXPECT_EQ(reading_error("filter:\n  inner:\n    loss: none\n"),
            "FILE:2: unknown key 'filter.inner': the nearest known key is 'filter.loss'");
}

TEST(ReadConfig, AKeyThatStandsTwiceIsRefused) {
  EXPECT_EQ(reading_error("filter:\n  loss: none\n  loss: huber\n"),
            "FILE:3: key 'filter.loss' stands twice in this file");
  EXPECT_EQ(reading_error("filter: {loss: none}\nfilter: {iterations: 3}\n"),
            "FILE:2: key 'filter' stands twice in this file");
}

TEST(ReadConfig, APoseNeedsSevenNumbersAndAQuaternionThatIsNotZero) {
  EXPECT_EQ(reading_error("T_body_lidar: [0, 0, 0, 0, 0, 1]\n"),
            "FILE:1: T_body_lidar: expected a pose [x, y, z, qx, qy, qz, qw], found a list of 6 "
            "values");
  EXPECT_EQ(reading_error("T_body_lidar: [0, 0, 0, 0, 0, 0, 0]\n"),
            "FILE:1: T_body_lidar: expected a quaternion that is not zero, found [qx, qy, qz, qw] "
            "= 0");
}

TEST(ReadConfig, TextThatIsNotYamlNamesTheLine) {
  const std::string message = reading_error("filter:\n  loss: [none\ndeskew: }\n");
  EXPECT_TRUE(message.starts_with("FILE:3: expected YAML, found: ")) << message;
  EXPECT_EQ(reading_error("a: 1\n---\nb: 2\n"), "FILE: expected one YAML document, found 2");
}

TEST(ReadConfig, AFileThatCannotBeReadOrIsNoConfigurationIsNamed) {
  ExampleConfig config;
  auto fields = fields_of(config);
  const Status absent = read_config_file("/nonexistent/run.yaml", fields);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().message,
            "/nonexistent/run.yaml: cannot be read: No such file or directory");
  EXPECT_FALSE(read_config_file(::testing::TempDir(), fields));
  EXPECT_EQ(reading_error(std::string(2 << 20, '#')),
            "FILE: expected a configuration of at most 1048576 bytes, found 2097152 bytes");
}

TEST(ReadConfig, BytesOfAnyKindEndInAnErrorAndNotInACrash) {
  const std::string nested(20000, '[');
  EXPECT_NE(reading_error(nested), "");
  EXPECT_NE(reading_error(std::string("\x00\x01\xff\xfe filter", 11)), "");
  EXPECT_NE(reading_error("filter: *nowhere\n"), "");
  EXPECT_NE(reading_error("? [a, b]\n: 1\n"), "");
}

TEST(CheckRequired, NamesTheKeysThatNothingHasSet) {
  ExampleConfig config;
  auto fields = fields_of(config);
  const Status missing = check_required("run.yaml", fields);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message,
            "run.yaml: missing, and there is no default: 'T_body_lidar' (lidar in the body frame)");
  ASSERT_TRUE(set_field("T_body_lidar=[0, 0, 0, 0, 0, 0, 1]", fields));
  EXPECT_TRUE(check_required("run.yaml", fields));
}

}  // namespace
}  // namespace holdfast::io::testing
