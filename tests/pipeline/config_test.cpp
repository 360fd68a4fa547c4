#include "holdfast/pipeline/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "tests/map/built_map.hpp"

namespace holdfast::pipeline {
namespace {

using map::testing::ScratchFolder;
using ::testing::HasSubstr;

const std::string kExtrinsic = "T_body_lidar=[0.1, -0.2, 0.3, 0, 0, 0, 1]";

std::filesystem::path file_with(const ScratchFolder& folder, const std::string& text) {
  const auto path = folder.path() / "config.yaml";
  std::ofstream(path) << text;
  return path;
}

std::string failure(const Result<Config>& config) { return config ? "" : config.error().message; }

TEST(LoadConfig, AMissingExtrinsicIsAnErrorThatNamesItsKey) {
  EXPECT_THAT(failure(load_config("", {})), HasSubstr("T_body_lidar"));
  const ScratchFolder folder;
  const auto path = file_with(folder, "start:\n  position_m: 0.5\n");
  EXPECT_THAT(failure(load_config(path, {})), HasSubstr("T_body_lidar"));
  EXPECT_THAT(failure(load_config(path, {})), HasSubstr(path.string()));
}

TEST(LoadConfig, WithTheExtrinsicTheDefaultsAreComplete) {
  const auto config = load_config("", {kExtrinsic});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->T_body_lidar.translation, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(config->method, "graph");
  const Config defaults;
  EXPECT_EQ(config->start.position_m, defaults.start.position_m);
  EXPECT_EQ(config->map_filter.gate_m, defaults.map_filter.gate_m);
}

TEST(LoadConfig, TheFileComesOverTheDefaultsAndAssignmentsOverTheFile) {
  const ScratchFolder folder;
  const auto path = file_with(folder,
                              "T_body_lidar: [1, 2, 3, 0, 0, 0, 1]\n"
                              "start: {position_m: 0.25, rotation_deg: 3}\n");
  const auto config = load_config(path, {"start.rotation_deg=7"});
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->T_body_lidar.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(config->start.position_m, 0.25);
  EXPECT_EQ(config->start.rotation_deg, 7.0);
  EXPECT_EQ(config->start.speed_m_s, Config{}.start.speed_m_s);
}

TEST(LoadConfig, AnUnknownKeyNamesTheNearestOne) {
  EXPECT_THAT(failure(load_config("", {kExtrinsic, "map_filter.gates_m=1"})),
              HasSubstr("map_filter.gate_m"));
  const ScratchFolder folder;
  const auto path = file_with(folder, "imu:\n  gyro_noise: 1e-4\n");
  EXPECT_THAT(failure(load_config(path, {kExtrinsic})), HasSubstr("imu.gyro_noise"));
  EXPECT_THAT(failure(load_config(path, {kExtrinsic})), HasSubstr(path.string()));
}

TEST(LoadConfig, ValuesOutOfRangeAreErrors) {
  for (const char* assignment :
       {"start.position_m=-1", "start.rotation_deg=90", "preprocess.max_points=0",
        "lidar.range_sigma_m=0", "map_filter.gate_m=nan", "method=magic", "start.position_m=far"}) {
    const std::string key = std::string(assignment).substr(0, std::string(assignment).find('='));
    EXPECT_THAT(failure(load_config("", {kExtrinsic, assignment})), HasSubstr(key)) << assignment;
  }
}

TEST(LoadConfig, AFileThatIsNotThereNamesItself) {
  EXPECT_THAT(failure(load_config("/nowhere/config.yaml", {kExtrinsic})),
              HasSubstr("/nowhere/config.yaml"));
}

TEST(FieldsOf, EveryFieldHasAKeyOfItsOwnAndADocThatSaysSomething) {
  Config config;
  std::set<std::string> keys;
  for (const io::FieldRef& field : fields_of(config)) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key << " twice";
    EXPECT_GE(field.doc.text.size(), 8U) << field.key;
    EXPECT_LE(field.doc.min, field.doc.max) << field.key;
    EXPECT_NE(field.value, nullptr);
  }
  EXPECT_GE(keys.size(), 19U);
}

TEST(FieldsOf, EveryNumberHasARangeThatItsDefaultLiesIn) {
  Config config;
  for (const io::FieldRef& field : fields_of(config)) {
    double value = 0;
    if (field.type == io::FieldRef::Type::kDouble) {
      value = *static_cast<double*>(field.value);
    } else if (field.type == io::FieldRef::Type::kInt) {
      value = *static_cast<int*>(field.value);
    } else {
      continue;
    }
    EXPECT_TRUE(std::isfinite(field.doc.min) && std::isfinite(field.doc.max)) << field.key;
    EXPECT_GE(value, field.doc.min) << field.key;
    EXPECT_LE(value, field.doc.max) << field.key;
  }
}

TEST(WriteConfig, WhatARunWritesIsReadBackToTheSameValues) {
  Config config;
  config.T_body_lidar = {so3::exp({0.1, 0.2, 0.3}), {1.0 / 3, -2e-7, 12345.678}};
  config.has_T_body_lidar = true;
  config.start.position_m = 0.1 + 0.2;
  config.map_filter.lost_sigma_m = 1.0 / 3;
  config.preprocess.max_points = 4321;
  const ScratchFolder folder;
  const std::string text = io::write_config(fields_of(config));
  auto read = load_config(file_with(folder, text), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(io::write_config(fields_of(*read)), text);
  EXPECT_EQ(read->start.position_m, config.start.position_m);
  EXPECT_EQ(read->map_filter.lost_sigma_m, config.map_filter.lost_sigma_m);
  EXPECT_EQ(read->T_body_lidar.translation, config.T_body_lidar.translation);
}

}  // namespace
}  // namespace holdfast::pipeline
