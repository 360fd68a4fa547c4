#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "holdfast/core/random.hpp"
#include "tests/io/config_example.hpp"

namespace holdfast::io::testing {
namespace {

/// Same bits, which tells -0 from 0.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

ExampleConfig written_and_read(ExampleConfig& config) {
  ExampleConfig copy;
  auto fields = fields_of(copy);
  const Status status =
      read_config_file(ExampleFile(write_config(fields_of(config))).path(), fields);
  EXPECT_TRUE(status) << status.error().message;
  return copy;
}

TEST(WriteConfig, IsABlockAModuleInTheOrderOfTheFieldLists) {
  ExampleConfig config;
  config.has_extrinsic = true;
  EXPECT_EQ(write_config(fields_of(config)),
            "T_body_lidar: [0, 0, 0, 0, 0, 0, 1]\n"
            "filter:\n"
            "  range_sigma_m: 0.02\n"
            "  iterations: 4\n"
            "  use_rings: true\n"
            "  loss: huber\n"
            "  voxels_m: [0.5, 1]\n"
            "deskew:\n"
            "  max_gap_s: 0.05\n"
            "  topic: \"\"\n");
}

TEST(WriteConfig, ARequiredKeyThatIsNotSetIsNeverWrittenAsAValue) {
  ExampleConfig config;
  const std::string text = write_config(fields_of(config));
  EXPECT_TRUE(text.starts_with("# T_body_lidar: required, without a default\nfilter:\n")) << text;
  EXPECT_FALSE(written_and_read(config).has_extrinsic);
}

TEST(WriteConfig, DoublesReadBackBitForBit) {
  RandomStream random(7, "config doubles");
  ExampleConfig config;
  for (int i = 0; i < 2000; ++i) {
    const double magnitude = std::exp2(random.uniform(-1000, 1000));
    config.deskew.max_gap_s = magnitude;
    EXPECT_TRUE(same_bits(written_and_read(config).deskew.max_gap_s, magnitude)) << magnitude;
  }
  for (const double edge :
       {0.0, -0.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(),
        0.1, 1.0 / 3.0, 1e22, 123456789.0}) {
    config.deskew.max_gap_s = edge;
    EXPECT_TRUE(same_bits(written_and_read(config).deskew.max_gap_s, edge)) << edge;
  }
}

TEST(WriteConfig, PosesReadBackBitForBit) {
  RandomStream random(8, "config poses");
  ExampleConfig config;
  config.has_extrinsic = true;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
    config.T_body_lidar.rotation = Eigen::Quaterniond(q).normalized();
    config.T_body_lidar.translation = {random.normal(), -0.0, 1e6 * random.normal()};
    const SE3 copy = written_and_read(config).T_body_lidar;
    for (int k = 0; k < 4; ++k) {
      EXPECT_TRUE(same_bits(copy.rotation.coeffs()[k], config.T_body_lidar.rotation.coeffs()[k]));
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(same_bits(copy.translation[k], config.T_body_lidar.translation[k]));
    }
  }
}

TEST(WriteConfig, TextReadsBackWhateverItHolds) {
  ExampleConfig config;
  for (const char* text : {"",
                           "null",
                           "~",
                           "true",
                           "no",
                           "1.5",
                           "0x10",
                           "/points",
                           "points",
                           "a: b",
                           "- a",
                           "# a",
                           "[a]",
                           " a ",
                           "a\nb\tc\r",
                           "\"quoted\" \\ 'single'",
                           "\x01\x1f\x7f",
                           "Größe 测量",
                           "*a",
                           "&a",
                           "!a",
                           "%a",
                           "@a",
                           "`a",
                           "---",
                           "...",
                           "<<",
                           "a #b",
                           "{a: 1}",
                           "|",
                           ">"}) {
    config.deskew.topic = text;
    EXPECT_EQ(written_and_read(config).deskew.topic, text);
  }
}

TEST(WriteConfig, ListsReadBackBitForBit) {
  ExampleConfig config;
  for (const std::vector<double>& list :
       {std::vector<double>{}, {0.1}, {1.0 / 3.0, 0.05, 10.0, 9.999999999999998}}) {
    config.filter.voxels_m = list;
    EXPECT_EQ(written_and_read(config).filter.voxels_m, list);
  }
}

TEST(SetField, SetsEveryType) {
  ExampleConfig config;
  auto fields = fields_of(config);
  for (const char* assignment :
       {"filter.range_sigma_m=0.5", "filter.iterations=2", "filter.use_rings=false",
        "filter.loss=none", "filter.voxels_m=[1,2, 3]", "deskew.topic=a=b: c #d",
        "T_body_lidar=[1, 2, 3, 0, 0, 0, 2]"}) {
    const Status status = set_field(assignment, fields);
    ASSERT_TRUE(status) << status.error().message;
  }
  EXPECT_EQ(config.filter.range_sigma_m, 0.5);
  EXPECT_EQ(config.filter.iterations, 2);
  EXPECT_FALSE(config.filter.use_rings);
  EXPECT_EQ(config.filter.loss, "none");
  EXPECT_EQ(config.filter.voxels_m, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(config.deskew.topic, "a=b: c #d");
  EXPECT_EQ(config.T_body_lidar.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(config.T_body_lidar.rotation.w(), 1.0);
  EXPECT_TRUE(config.has_extrinsic);
}

TEST(SetField, ErrorsNameTheAssignmentExpectedAndFound) {
  ExampleConfig config;
  auto fields = fields_of(config);
  const auto message = [&](const char* assignment) {
    const Status status = set_field(assignment, fields);
    return status ? std::string("no error") : status.error().message;
  };
  EXPECT_EQ(message("filter.iterations"),
            "--set filter.iterations: expected module.key=value, found no '='");
  EXPECT_EQ(message("filter.iteration=3"),
            "--set filter.iteration=3: unknown key 'filter.iteration': the nearest known key is "
            "'filter.iterations'");
  EXPECT_EQ(message("filter.iterations=many"),
            "--set filter.iterations=many: expected a whole number from 1 to 20, found 'many'");
  EXPECT_EQ(message("filter.iterations="),
            "--set filter.iterations=: expected a whole number from 1 to 20, found ''");
  EXPECT_EQ(message("T_body_lidar=[1, 2"),
            "--set T_body_lidar=[1, 2:1: expected YAML, found: end of sequence flow not found");
  EXPECT_EQ(config.filter.iterations, 4);
}

TEST(ConfigReference, IsATableAModuleWithDefaultRangeAndMeaning) {
  ExampleConfig config;
  EXPECT_EQ(
      config_reference(fields_of(config)),
      "## top level\n\n"
      "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
      "| `T_body_lidar` | pose | required | x, y, z, qx, qy, qz, qw | lidar in the body frame |\n"
      "\n## filter\n\n"
      "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
      "| `range_sigma_m` | number | `0.02` | 0.001 to 1 | noise of a range |\n"
      "| `iterations` | whole number | `4` | 1 to 20 | updates a scan |\n"
      "| `use_rings` | true or false | `true` |  | whether rings are used |\n"
      "| `loss` | text | `huber` | none\\|huber\\|cauchy | robust loss |\n"
      "| `voxels_m` | list of numbers | `[0.5, 1]` | 0.05 to 10 | sizes of voxels |\n"
      "\n## deskew\n\n"
      "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
      "| `max_gap_s` | number | `0.05` | >= 0 | longest IMU gap bridged |\n"
      "| `topic` | text | `\"\"` |  | any text |\n");
}

}  // namespace
}  // namespace holdfast::io::testing
