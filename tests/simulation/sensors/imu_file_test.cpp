#include "simulation/sensors/imu/imu_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using ::testing::HasSubstr;

class NamedImu : public ::testing::TestWithParam<std::string_view> {};

TEST_P(NamedImu, DrivesAndReadsGravityWithinItsFullScale) {
  const auto imu = make_imu(std::string(GetParam()));
  ASSERT_TRUE(imu) << imu.error().message;
  SimulationOptions options;
  options.scenario = "box";
  options.duration_s = 1;
  options.lidar.columns = 1;
  options.imu = *imu;
  const auto log = testing::record(*testing::make(options));
  ASSERT_EQ(log.imu.size(), 201U);
  for (const ImuSample& sample : log.imu) {
    // Six times what biases, white noise and scale do together at rest.
    const double sigma = imu->accel_bias_initial + imu->accel_noise_density * std::sqrt(200) +
                         9.81 * imu->faults.accel_scale_sigma;
    ASSERT_NEAR(sample.accel_m_s2.z(), 9.81, 6 * sigma);
  }
}

INSTANTIATE_TEST_SUITE_P(All, NamedImu, ::testing::ValuesIn(imu_names()),
                         [](const auto& named) { return std::string(named.param); });

TEST(ImuFile, TheDefaultOneHasNoFaults) {
  const ImuModel article = *make_imu("article");
  const ImuModel model;
  EXPECT_EQ(article.gyro_noise_density, model.gyro_noise_density);
  EXPECT_EQ(article.faults.accel_scale_sigma, 0);
  EXPECT_GT(make_imu("n200")->faults.accel_scale_sigma, 0);
}

struct ImuOnDisk : ::testing::Test {
  std::string path = ::testing::TempDir() + "imu_file_test.yaml";

  Result<ImuModel> read(const std::string& text) {
    std::ofstream(path) << text;
    return make_imu(path);
  }
  std::string complaint(const std::string& text) {
    const auto model = read(text);
    EXPECT_FALSE(model) << text;
    return model ? "" : model.error().message;
  }
};

TEST_F(ImuOnDisk, SaysWhatIsDifferentFromTheDefault) {
  const auto imu = read("rate_hz: 400\ngyro_scale_sigma: 0.02");
  ASSERT_TRUE(imu) << imu.error().message;
  EXPECT_EQ(imu->rate_hz, 400);
  EXPECT_EQ(imu->faults.gyro_scale_sigma, 0.02);
  EXPECT_EQ(imu->accel_noise_density, ImuModel().accel_noise_density);
}

TEST_F(ImuOnDisk, ErrorsSayWhatIsExpected) {
  EXPECT_THAT(complaint("gyro_scale: 0.1"), HasSubstr("nearest known key is"));
  EXPECT_THAT(complaint("rate_hz: 300"), HasSubstr("whole number of ns"));
  EXPECT_THAT(complaint("accel_full_scale_m_s2: 5"), HasSubstr("more than gravity"));
  EXPECT_THAT(complaint("gyro_scale_sigma: 3"), HasSubstr("imu_file_test.yaml:1"));
  EXPECT_THAT(complaint("gyro_full_scale_rad_s: 1\ngyro_resolution_rad_s: 1.5"),
              HasSubstr("gyro_resolution_rad_s"));
  const auto unknown = make_imu("n300");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("article, n200, bmi088"));
}

}  // namespace
}  // namespace holdfast::simulation
