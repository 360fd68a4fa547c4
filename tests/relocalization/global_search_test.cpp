#include "holdfast/relocalization/global_search.hpp"

#include <gtest/gtest.h>

#include "tests/places/placed_map.hpp"

namespace holdfast::relocalization {
namespace {

using Eigen::Vector3d;
using places::testing::PlacedMap;

constexpr double kNoiseM = 0.02;

/// A room of 12 x 8 x 3 m; with a closet in one corner, or a rectangle that looks the same from the
/// other end.
io::PointCloud room(bool with_closet) {
  io::PointCloud cloud = places::testing::room({0, 0, 0}, {12, 8, 3});
  if (!with_closet) return cloud;
  RandomStream random(2, "closet");
  map::testing::add_patch({0, 2.5, 0}, {3, 0, 0}, {0, 0, 3}, random, cloud.points);
  map::testing::add_patch({3, 0, 0}, {0, 2.5, 0}, {0, 0, 3}, random, cloud.points);
  return cloud;
}

/// What a LiDAR at T_map_body sees: 16 rings of 360 rays to the surfaces of that room.
SearchQuery query_at(const SE3& T_map_body, bool with_closet) {
  RandomStream random(3, "returns");
  SearchQuery query;
  for (int i = 0; i < 16 * 360; ++i) {
    const double e = (-15.0 + 2.0 * (i % 16)) * M_PI / 180, a = (i / 16) * M_PI / 180;
    const Vector3d ray(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
    const Vector3d d = T_map_body.rotation * ray;
    const Vector3d& p = T_map_body.translation;
    double range = 1e9;
    const Vector3d size(12, 8, 3);
    for (int k = 0; k < 3; ++k) range = std::min(range, ((d[k] > 0 ? size[k] : 0) - p[k]) / d[k]);
    if (with_closet) {
      const double to_x = (3 - p.x()) / d.x(), to_y = (2.5 - p.y()) / d.y();
      if (to_x > 0 && p.y() + to_x * d.y() < 2.5) range = std::min(range, to_x);
      if (to_y > 0 && p.x() + to_y * d.x() < 3) range = std::min(range, to_y);
    }
    query.points.points.push_back(((range + random.normal(0, kNoiseM)) * ray).cast<float>());
    query.points.age_s.push_back(0);
  }
  query.gravity_body = T_map_body.rotation.conjugate() * -Vector3d::UnitZ();
  return query;
}

SE3 pose(double x, double y, double yaw) {
  return {so3::exp({0, 0, yaw}) * so3::exp({0.02, -0.03, 0}), {x, y, 0.8}};
}

SearchReport search(const PlacedMap& map, const SearchQuery& query) {
  auto search = GlobalSearch::create(map.path(), {});
  if (search) return search->find(query);
  ADD_FAILURE() << search.error().message;
  return {};
}

TEST(GlobalSearch, FindsThePoseInARoomThatLooksTheSameFromNowhereElse) {
  const PlacedMap map(room(true));
  const SE3 truth = pose(7.3, 5.1, 2.0);
  const SearchReport report = search(map, query_at(truth, true));
  ASSERT_EQ(report.outcome, SearchOutcome::kFound) << report.reason;
  EXPECT_LT((report.T_map_body->translation - truth.translation).norm(), 0.02);
  EXPECT_LT(so3::angle_between(report.T_map_body->rotation, truth.rotation), 0.005);
  EXPECT_GT(report.work, 0U);
}

TEST(GlobalSearch, DoesNotChooseBetweenTheEndsOfARectangle) {
  const PlacedMap map(room(false));
  const SearchReport report = search(map, query_at(pose(7.3, 5.1, 2.0), false));
  EXPECT_EQ(report.outcome, SearchOutcome::kAmbiguous) << report.reason;
  EXPECT_GE(report.candidates.size(), 2U);
}

TEST(GlobalSearch, TheSameQueryHasTheSameAnswer) {
  const PlacedMap map(room(true));
  const SearchQuery query = query_at(pose(5.2, 5.9, -1.0), true);
  const SearchReport a = search(map, query), b = search(map, query);
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  EXPECT_EQ(a.work, b.work);
  EXPECT_EQ(a.probability, b.probability);
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].T_map_body.translation, b.candidates[i].T_map_body.translation);
  }
}

TEST(GlobalSearch, AScanOfAlmostNothingIsTooPoor) {
  const PlacedMap map(room(true));
  SearchQuery query = query_at(pose(7.3, 5.1, 2.0), true);
  query.points.resize(20);
  EXPECT_EQ(search(map, query).outcome, SearchOutcome::kTooPoor);
  query.points.resize(0);
  EXPECT_EQ(search(map, query).outcome, SearchOutcome::kTooPoor);
}

}  // namespace
}  // namespace holdfast::relocalization
