#include <cmath>
#include <filesystem>
#include <fstream>

#include "holdfast/io/tum_file.hpp"
#include "tests/interface/workspace.hpp"

/// The options that make a drive harder than its scenario is.
namespace holdfast::testing {
namespace {

using ::testing::HasSubstr;

class HardDrive : public ::testing::Test {
 protected:
  /// The folder of a drive through the office with these options.
  std::string drive(const std::string& name, const std::string& options) {
    const std::string to = out / name;
    last = expect_run("simulate office --seed 4 --duration 5 --out " + to + " " + options, 0);
    return to;
  }
  static std::vector<StampedPose> truth(const std::string& dir) {
    const auto track = io::read_tum(dir + "/truth.tum");
    EXPECT_TRUE(track) << track.error().message;
    return *track;
  }
  static double way_m(const std::string& dir) {
    double sum = 0;
    const auto track = truth(dir);
    for (std::size_t i = 1; i < track.size(); ++i) {
      sum += (track[i].T_map_body.translation - track[i - 1].T_map_body.translation).norm();
    }
    return sum;
  }
  /// Largest angle between the body's z and the map's.
  static double tilt_deg(const std::string& dir) {
    double most = 0;
    for (const auto& pose : truth(dir)) {
      const double cosine = (pose.T_map_body.rotation * Eigen::Vector3d::UnitZ()).z();
      most = std::max(most, std::acos(std::min(cosine, 1.0)) * 180 / M_PI);
    }
    return most;
  }
  static bool same(const std::string& a, const std::string& b, const std::string& file) {
    return content(a + "/" + file) == content(b + "/" + file);
  }

  Workspace out;
  ProgramRun last;
};

/// The page's own example.
TEST(ScenarioFileOnDisk, IsDrivenThrough) {
  const Workspace out;
  const std::string page = expect_run("simulate --reference", 0).out;
  const std::string fence = "```yaml\n";
  const auto begin = page.find(fence) + fence.size();
  std::ofstream(out / "shed.yaml") << page.substr(begin, page.find("```", begin) - begin);
  expect_run("simulate " + (out / "shed.yaml") + " --duration 3 --out " + (out / "drive"), 0);
  EXPECT_TRUE(std::filesystem::exists(out / "drive/run.bag"));
  const auto wrong = expect_run("simulate shed.yml --out " + (out / "drive"), 2);
  EXPECT_THAT(wrong.out, HasSubstr("files that end in .yaml"));
}

TEST(WorldFileOnDisk, IsDrivenThroughAlongAWayThatIsFound) {
  const Workspace out;
  std::ofstream(out / "field.obj") << "v 0 0 0\nv 40 0 0\nv 40 20 0\nv 0 20 0\nf 1 2 3 4\n"
                                   << "v 0 0 6\nv 40 0 6\nf 1 2 6 5\n";
  const std::string drive = out / "drive";
  const auto run =
      expect_run("simulate " + (out / "field.obj") + " --duration 2 --out " + drive, 0);
  EXPECT_THAT(run.out, HasSubstr("the way found through this world is"));
  EXPECT_THAT(content(drive + "/config.yaml"), HasSubstr("# the way found through this world is"));
  EXPECT_TRUE(std::filesystem::exists(drive + "/map.pcd"));
  EXPECT_FALSE(std::filesystem::exists(drive + "/aliases.jsonl"));
  const auto wrong = expect_run("simulate none.pcd --out " + drive, 2);
  EXPECT_THAT(wrong.out, HasSubstr("none.pcd"));
}

TEST(AliasesOfADrive, AreWrittenWhenAskedFor) {
  const Workspace out;
  const std::string drive = out / "drive";
  const auto run = expect_run("simulate box --duration 4 --aliases --out " + drive, 0);
  EXPECT_THAT(run.out, HasSubstr("aliases.jsonl: 4.0 s look like other places"));
  EXPECT_THAT(content(drive + "/aliases.jsonl"), HasSubstr("\"poses\":[["));
}

TEST_F(HardDrive, AnotherLidarSeesOtherPoints) {
  const auto plain = drive("plain", "");
  const auto vlp = drive("vlp", "--lidar vlp16");
  EXPECT_FALSE(same(plain, vlp, "run.bag"));
  EXPECT_TRUE(same(plain, vlp, "map.pcd")) << "the survey is none of the robot's";
  const auto wrong = expect_run("simulate office --lidar vlp61 --out " + (out / "wrong"), 2);
  EXPECT_THAT(wrong.out, HasSubstr("known are: rs16, vlp16"));
}

TEST_F(HardDrive, FaultsAreOfTheSensorsAndNotOfTheDrive) {
  const auto plain = drive("plain", "");
  for (const char* fault :
       {"--imu n200", "--faults imu", "--faults clock", "--faults packets",
        "--faults imu,clock,packets,extrinsics", "--wheel --gnss", "--event clock_jump@2+1"}) {
    const auto faulty = drive("faulty", fault);
    EXPECT_FALSE(same(plain, faulty, "run.bag")) << fault;
    EXPECT_TRUE(same(plain, faulty, "truth.tum")) << fault;
    EXPECT_TRUE(same(plain, faulty, "map.pcd")) << fault;
  }
  const auto off = drive("off", "--faults extrinsics");
  EXPECT_TRUE(same(plain, off, "run.bag"));
  EXPECT_FALSE(same(plain, off, "config.yaml"));
  const auto wrong = expect_run("simulate office --faults imu,weather --out " + (out / "wrong"), 2);
  EXPECT_THAT(wrong.out, HasSubstr("unknown fault 'weather'; known are: lidar, imu, clock"));
  const auto strange = expect_run("simulate office --imu n300 --out " + (out / "wrong"), 2);
  EXPECT_THAT(strange.out, HasSubstr("known are: article, n200"));
}

TEST_F(HardDrive, AChangedWorldIsAnotherOnTheSameWay) {
  const auto plain = drive("plain", "");
  EXPECT_EQ(last.out.find("changed since the survey"), std::string::npos) << last.out;
  const auto changed = drive("changed", "--changed 40%");
  EXPECT_THAT(last.out, HasSubstr("objects changed since the survey"));
  EXPECT_FALSE(same(plain, changed, "run.bag"));
  EXPECT_TRUE(same(plain, changed, "truth.tum"));
}

TEST_F(HardDrive, SpeedAndWobbleAreThoseOfTheTruth) {
  const auto plain = drive("plain", "");
  const auto fast = drive("fast", "--speed 2");
  const auto rough = drive("rough", "--wobble 3");
  EXPECT_GT(way_m(fast), 1.5 * way_m(plain));
  EXPECT_GT(way_m(plain), 0.5);
  EXPECT_LT(tilt_deg(plain), 0.5);  // a robot on wheels leans a little
  EXPECT_GT(tilt_deg(rough), 1.5);
  EXPECT_LT(tilt_deg(rough), 3 * std::sqrt(2.0) + 0.5);  // roll and pitch at once
}

TEST_F(HardDrive, NoiseOfTheRangesIsInTheLogAndNoiseOfTheMapInTheMap) {
  const auto plain = drive("plain", "");
  const auto noisy = drive("noisy", "--range-noise 0.05");
  const auto rough_map = drive("rough_map", "--map-noise 0.03");
  EXPECT_THAT(content(noisy + "/config.yaml"), HasSubstr("range_sigma_m: 0.05"));
  EXPECT_FALSE(same(plain, noisy, "run.bag"));
  EXPECT_TRUE(same(plain, noisy, "map.pcd"));
  EXPECT_TRUE(same(plain, rough_map, "run.bag"));
  EXPECT_FALSE(same(plain, rough_map, "map.pcd"));
}

TEST_F(HardDrive, FaultsAndWeatherAreInTheLogAndInItsConfiguration) {
  const auto plain = drive("plain", "");
  const auto faulty = drive("faulty", "--faults lidar");
  const auto wet = drive("wet", "--rain 20 --visibility 200");
  EXPECT_THAT(content(faulty + "/config.yaml"), HasSubstr("#   mixed_pixels: true"));
  EXPECT_THAT(content(wet + "/config.yaml"),
              HasSubstr("# weather: rain 20 mm/h, visibility 200 m"));
  for (const auto& hard : {faulty, wet}) {
    EXPECT_FALSE(same(plain, hard, "run.bag"));
    EXPECT_TRUE(same(plain, hard, "truth.tum"));
    EXPECT_TRUE(same(plain, hard, "map.pcd"));
  }
  const auto wrong = expect_run("simulate office --faults lidra --out " + (out / "wrong"), 2);
  EXPECT_THAT(wrong.out, HasSubstr("unknown fault 'lidra'; known are: lidar"));
}

TEST_F(HardDrive, HardshipsOutsideOfTheirRangesAreWrongUsage) {
  for (const char* bad :
       {"--changed 101", "--changed -1", "--changed much", "--speed 0", "--speed 11", "--wobble 31",
        "--range-noise -1", "--map-noise -1", "--rain -1", "--rain 201", "--visibility 1"}) {
    expect_run("simulate office --duration 1 --out " + out / "sim" + " " + bad, 2);
  }
  EXPECT_TRUE(out.names().empty());
}

}  // namespace
}  // namespace holdfast::testing
