#include <nlohmann/json.hpp>

#include "tests/interface/workspace.hpp"

namespace holdfast::testing {
namespace {

using ::testing::HasSubstr;

const std::string kArticle = std::string(HOLDFAST_SOURCE) + "/config/article.yaml";

/// A drive through the corridor, made once for all tests of a process.
class ArticleMethod : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    files = new Workspace;
    expect_run("simulate corridor --seed 2 --duration 6 --out " + *files / "sim", 0);
    expect_run("map import " + *files / "sim/map.pcd" + " --out " + *files / "map", 0);
    for (const std::string& line : lines_of(content(*files / "sim/config.yaml"))) {
      if (line.starts_with("# initial_pose: ")) pose = line.substr(16);
      if (line.starts_with("T_body_lidar: ")) extrinsic = line.substr(14);
    }
  }
  static void TearDownTestSuite() {
    delete files;
    files = nullptr;
  }
  static std::string localize(const std::string& out, const std::string& more) {
    return "localize " + *files / "sim/run.bag" + " --map " + *files / "map" + " --out " + out +
           " --no-report --initial-pose \"" + pose + "\" " + more;
  }
  nlohmann::json evaluated(const std::string& run) const {
    const auto told = expect_run(
        "evaluate " + run + "/trajectory.tum --truth " + *files / "sim/truth.tum" + " --json", 0);
    return nlohmann::json::parse(told.out);
  }
  /// Mean of a column of steps.csv.
  static double mean_matches(const std::string& run) {
    const auto lines = lines_of(content(run + "/steps.csv"));
    EXPECT_THAT(lines.front(),
                ::testing::StartsWith("stamp,pose_time,status,reason,p_wrong,matches"));
    double sum = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      std::istringstream cells(lines[i]);
      std::string cell;
      for (int column = 0; column < 6; ++column) std::getline(cells, cell, ',');
      sum += std::stod(cell);
    }
    return sum / static_cast<double>(lines.size() - 1);
  }

  static Workspace* files;
  static std::string pose, extrinsic;
  Workspace out;
};
Workspace* ArticleMethod::files = nullptr;
std::string ArticleMethod::pose;
std::string ArticleMethod::extrinsic;

/// Its edges are no edges, and pull the pose to lines up to r_E = 2 m away (`bench ablation`): it
/// stays in the corridor of 3 m, and is no good.
TEST_F(ArticleMethod, AsPrintedStaysInTheCorridor) {
  const std::string run = out / "run";
  expect_run(localize(run, "--config " + kArticle + " --set \"T_body_lidar=" + extrinsic + "\""),
             0);
  EXPECT_THAT(content(run + "/config.yaml"), HasSubstr("fit_at_query: true"));
  const auto result = evaluated(run);
  EXPECT_LT(result["ate_max_m"], 1.5) << result.dump(2);
  EXPECT_GT(result["coverage"], 0.99) << result.dump(2);
}

TEST_F(ArticleMethod, WithItsPlanesAloneFollowsTheCorridor) {
  const std::string run = out / "run";
  expect_run(localize(run, "--config " + kArticle + " --set \"T_body_lidar=" + extrinsic +
                               "\" --set query_matching.edge_weight=0"),
             0);
  const auto result = evaluated(run);
  EXPECT_LT(result["ate_rmse_m"], 0.05) << result.dump(2);
  EXPECT_GT(result["coverage"], 0.99) << result.dump(2);
}

TEST_F(ArticleMethod, MatchesFewerPointsWhenFeaturesAreSelected) {
  expect_run(localize(out / "all", ""), 0);
  expect_run(localize(out / "off", "--set features=off"), 0);
  EXPECT_EQ(content(out / "all/trajectory.tum"), content(out / "off/trajectory.tum"));
  for (const char* features : {"log", "fitted"}) {
    const std::string run = out / features;
    expect_run(localize(run, std::string("--set features=") + features), 0);
    EXPECT_LT(mean_matches(run), 0.8 * mean_matches(out / "all")) << features;
    const auto result = evaluated(run);
    EXPECT_LT(result["ate_rmse_m"], 0.05) << features << result.dump(2);
  }
  expect_run(localize(out / "graph", "--set features=fitted --method graph"), 0);
  EXPECT_LT(mean_matches(out / "graph"), 0.8 * mean_matches(out / "all"));
}

TEST_F(ArticleMethod, HasLimitsThatTakeEffect) {
  const std::string log = "--method map_filter --set features=log ";
  expect_run(localize(out / "wide", log), 0);
  expect_run(localize(out / "narrow", log + "--set feature_extraction.plane_sigmas=2.5 --set "
                                            "feature_extraction.edge_sigmas=2.5"),
             0);
  EXPECT_LT(mean_matches(out / "narrow"), 0.5 * mean_matches(out / "wide"));
  expect_run(localize(out / "query", log + "--set fit_at_query=true --set "
                                           "query_matching.least_planes=100000"),
             0);
  EXPECT_THAT(content(out / "query/steps.csv"), HasSubstr("too few features match the map"));
}

TEST_F(ArticleMethod, RefusesFitsAtQueryTimeWithoutFeaturesAndInTheGraph) {
  expect_run(localize(out / "run", "--set fit_at_query=true"), 1, "features: off");
  expect_run(localize(out / "run", "--set fit_at_query=true --set features=log --method graph"), 1,
             "method: graph");
  expect_run(localize(out / "run", "--set features=edges"), 1, "off|printed|log|fitted");
  EXPECT_TRUE(out.names().empty());
}

}  // namespace
}  // namespace holdfast::testing
