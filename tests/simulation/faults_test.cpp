#include "simulation/faults.hpp"

#include <gtest/gtest.h>

#include "simulation/log_output.hpp"
#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

TEST(Faults, AreAppliedByName) {
  SimulationOptions options;
  ASSERT_TRUE(apply_faults("lidar", options));
  EXPECT_FALSE(options.lidar.faults.none());
  EXPECT_EQ(options.lidar.faults.dropout_share, LidarFaults::usual().dropout_share);
}

TEST(Faults, UnknownNamesListTheKnownOnesAndChangeNothing) {
  for (const char* names : {"lidra", "lidar,imux", "lidar,", ""}) {
    SimulationOptions options;
    const Status applied = apply_faults(names, options);
    ASSERT_FALSE(applied) << names;
    EXPECT_NE(applied.error().message.find("known are: lidar"), std::string::npos);
    EXPECT_TRUE(options.lidar.faults.none());
  }
}

TEST(Faults, StandInTheConfigurationOfTheLog) {
  SimulationOptions options = testing::noise_free("box", 1);
  const std::string plain = robot_config(*testing::make(options));
  EXPECT_EQ(plain.find("faults"), std::string::npos);
  EXPECT_EQ(plain.find("weather"), std::string::npos);
  ASSERT_TRUE(apply_faults("lidar", options));
  options.weather.rain_mm_h = 20;
  const std::string text = robot_config(*testing::make(options));
  EXPECT_NE(text.find("#   dropout_share: 0.005"), std::string::npos) << text;
  EXPECT_NE(text.find("# weather: rain 20 mm/h"), std::string::npos) << text;
}

}  // namespace
}  // namespace holdfast::simulation
