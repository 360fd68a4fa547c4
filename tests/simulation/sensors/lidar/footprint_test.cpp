#include "simulation/sensors/lidar/returns/footprint.hpp"

#include <gtest/gtest.h>

#include <map>

#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::known_returns;
using testing::KnownReturn;
using testing::make;
using testing::still_at;
using testing::still_options;

constexpr double kNear = 4;
constexpr double kHalfWidth = 0.1;

/// Where panels stand about the origin, in degrees: one every twelve, and a little off.
double panel_azimuth(int i) { return (12.0 * i + 0.37 * (i % 7)) * std::numbers::pi / 180; }

/// Thirty upright panels, 0.2 m wide and square to the sight of someone at the origin, in front of
/// a round wall.
World panels_before_wall(double wall_m) {
  WorldBuilder build;
  for (int i = 0; i < 30; ++i) {
    const double azimuth = panel_azimuth(i);
    const Vector3d middle(kNear * std::cos(azimuth), kNear * std::sin(azimuth), 0);
    const Vector3d side(-kHalfWidth * std::sin(azimuth), kHalfWidth * std::cos(azimuth), 0);
    const Vector3d up(0, 0, 2);
    build.quad(middle - side - up, middle - side + up, middle + side + up, middle + side - up,
               materials::kIdeal);
  }
  build.cylinder({0, 0, -2}, wall_m, 4, materials::kIdeal, 720);
  return build.build();
}

/// One level beam of 3 mrad.
SimulationOptions one_beam(double duration_s) {
  SimulationOptions options = still_options(duration_s);
  options.lidar.beams = {{0, 0, 0}};
  options.lidar.faults.mixed_pixels = true;
  return options;
}

/// Share of a disc of radius 1 beyond a line at distance x from its centre.
double beyond(double x) {
  const double c = std::clamp(x, -1.0, 1.0);
  return (std::acos(c) - c * std::sqrt(1 - c * c)) / std::numbers::pi;
}

/// Of the beam, on its near side: how far the nearest edge of a panel lies from its axis, in radii
/// of the disc, and the share of the disc that the panel fills.
struct Place {
  double near_share = 0;
  bool straddles = false;
};

Place place_of(const Vector3d& from, const Vector3d& ray, double radius_rad) {
  Place place;
  double nearest = 1e9;
  for (int i = 0; i < 30; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double azimuth = panel_azimuth(i);
      const Vector3d edge(kNear * std::cos(azimuth) - side * kHalfWidth * std::sin(azimuth),
                          kNear * std::sin(azimuth) + side * kHalfWidth * std::cos(azimuth), 0);
      const Vector3d there = edge - from;
      const double turn = std::atan2(there.y(), there.x()) - std::atan2(ray.y(), ray.x());
      const double to_edge = std::remainder(turn, 2 * std::numbers::pi);
      if (std::abs(to_edge) >= nearest) continue;
      nearest = std::abs(to_edge);
      // A panel lies to the right of its left edge (side 1) and to the left of its right one.
      place = {beyond(-side * to_edge / radius_rad), nearest < radius_rad};
    }
  }
  return place;
}

double binomial(int n, int k) {
  return std::tgamma(n + 1) / std::tgamma(k + 1) / std::tgamma(n - k + 1);
}

/// Mean of the place between near (0) and far (1) when `far` of eight rays are far and a near one
/// counts `ratio` times as much. The share of the far rays' speckle has the Beta(far, 8 - far)
/// distribution; Simpson's rule.
double mean_place(int far, double ratio) {
  if (far == 0 || far == 8) return far / 8.0;
  const double norm = std::tgamma(8) / std::tgamma(far) / std::tgamma(8 - far);
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = static_cast<double>(i) / kSteps;
    const double density = norm * std::pow(x, far - 1) * std::pow(1 - x, 7 - far);
    const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * density * x / (x + ratio * (1 - x));
  }
  return sum / (3 * kSteps);
}

/// Of a beam that straddles an edge: how often its rays are not all on the axis's side, and the
/// mean of its place then.
struct Mixture {
  double chance = 0, place = 0;
};

Mixture mixture(double near_share, double ratio) {
  Mixture out;
  const int axis_far = near_share < 0.5 ? 8 : 0;
  for (int far = 0; far <= 8; ++far) {
    if (far == axis_far) continue;
    const double chance =
        binomial(8, far) * std::pow(1 - near_share, far) * std::pow(near_share, 8 - far);
    out.chance += chance;
    out.place += chance * mean_place(far, ratio);
  }
  return out;
}

TEST(Footprint, MixesSurfacesAtAnEdgeAsOftenAndWhereTheDiscSays) {
  SimulationOptions options = one_beam(8);
  constexpr double kFar = 4.5;
  const auto simulation = make(still_at({0, 0, 0.01}, panels_before_wall(kFar)), options);
  const double radius = options.lidar.divergence_rad / 2;
  double expected = 0, variance = 0, expected_place = 0;
  double mixed = 0, place = 0;
  for (const KnownReturn& r : known_returns(*simulation)) {
    const bool is_mixed = r.truth.kind == ReturnKind::kMixed;
    const Vector3d ray(r.ray_map.x(), r.ray_map.y(), 0);
    const Place where = place_of(r.from_map, ray, radius);
    if (!where.straddles) {
      ASSERT_FALSE(is_mixed);
      continue;
    }
    const Mixture mixture_here = mixture(where.near_share, kFar * kFar / (kNear * kNear));
    expected += mixture_here.chance;
    variance += mixture_here.chance * (1 - mixture_here.chance);
    expected_place += mixture_here.place;
    if (!is_mixed) continue;
    ++mixed;
    // The robot rests up to 6 cm from the origin: ranges are those of its own place.
    const double near_m = kNear - r.from_map.dot(ray);
    const double far_m = kFar - r.from_map.dot(ray);
    const double here = (r.range - near_m) / (far_m - near_m);
    ASSERT_GT(here, -0.02);
    ASSERT_LT(here, 1.02);
    place += here;
  }
  EXPECT_GT(mixed, 1500);
  EXPECT_NEAR(mixed, expected, tolerances::count_error(variance));
  // Places scatter by less than 0.5; the robot's own place changes the ratio of powers by less
  // than 2 * 0.06 * (1 / 4 - 1 / 4.5), and where a place is by as much as the ranges are off.
  EXPECT_NEAR(place / mixed, expected_place / expected,
              tolerances::mean_error(0.5, mixed) + 0.0034);
}

// Panels 2 m before the wall: the pulse is 0.9 m long.
TEST(Footprint, KeepsOneOfTwoSurfacesThatThePulseTellsApart) {
  for (const char* kept : {"strongest", "last"}) {
    SimulationOptions options = one_beam(3);
    options.lidar.faults.kept_return = kept;
    const auto simulation = make(still_at({0, 0, 0.01}, panels_before_wall(6)), options);
    double others = 0, far = 0;
    for (const KnownReturn& r : known_returns(*simulation)) {
      const double along = r.from_map.dot(Vector3d(r.ray_map.x(), r.ray_map.y(), 0));
      const bool is_near = std::abs(r.range + along - 4) < 0.01;
      const bool is_far = std::abs(r.range + along - 6) < 0.01;
      ASSERT_TRUE(is_near || is_far) << r.range;
      if (r.truth.kind == ReturnKind::kSurface) continue;
      ++others;
      far += is_far ? 1 : 0;
    }
    EXPECT_GT(others, 200);
    // Light from 4 m is (6 / 4)^2 times as strong; the last return is the far one wherever a ray
    // reaches it: only where all eight are near does the panel win.
    if (std::string(kept) == "last") {
      EXPECT_GT(far, 0.9 * others);
    } else {
      EXPECT_LT(far, 0.5 * others);
    }
  }
}

TEST(Footprint, LeavesBeamsOnOneSurfaceAsTheyAre) {
  SimulationOptions options = still_options(1);
  const auto world = [] { return testing::room_with_wall(materials::kIdeal); };
  const auto plain = testing::record(*make(still_at({3, 3, 1.2}, world()), options)).scans;
  options.lidar.faults.mixed_pixels = true;
  const auto mixed = testing::record(*make(still_at({3, 3, 1.2}, world()), options)).scans;
  for (std::size_t s = 0; s < plain.size(); ++s) {
    ASSERT_EQ(plain[s].points.size(), mixed[s].points.size());
    for (std::size_t i = 0; i < plain[s].points.size(); ++i) {
      ASSERT_LT(
          (testing::position(plain[s].points[i]) - testing::position(mixed[s].points[i])).norm(),
          0.12)
          << "creases bend a beam by less than its spot";
    }
  }
}

// Someone before a wall: a return between the two is neither.
TEST(Footprint, MixesPeopleWithWhatStandsBehindThem) {
  SimulationOptions options = testing::noise_free("office", 4);
  options.lidar.keep_all_returns = true;
  const auto plain = testing::make(options);
  options.lidar.faults.mixed_pixels = true;
  const auto blurred = testing::make(options);
  const auto before = testing::record(*plain).scans;
  const auto after = testing::record(*blurred).scans;
  std::size_t people = 0;
  std::size_t mixed_people = 0;
  for (std::size_t s = 1; s < before.size(); s += 6) {
    const auto truth_before = plain->true_geometry(before[s]);
    const auto truth_after = blurred->true_geometry(after[s]);
    std::map<std::pair<TimeNs, int>, std::size_t> place;
    for (std::size_t i = 0; i < before[s].points.size(); ++i) {
      const ScanPoint& p = before[s].points[i];
      place[{before[s].stamp + p.time_offset_ns, p.ring}] = i;
      people += truth_before[i].moving ? 1 : 0;
    }
    for (std::size_t i = 0; i < after[s].points.size(); ++i) {
      const ScanPoint& p = after[s].points[i];
      const auto found = place.find({after[s].stamp + p.time_offset_ns, p.ring});
      const bool is_mixed = truth_after[i].kind == ReturnKind::kMixed;
      if (found == place.end()) {
        ASSERT_TRUE(is_mixed) << "something beside an axis that meets nothing";
        continue;
      }
      if (!is_mixed) {
        ASSERT_EQ(p.x, before[s].points[found->second].x);
      }
      mixed_people += truth_before[found->second].moving && is_mixed ? 1 : 0;
    }
  }
  EXPECT_GT(people, 500U);
  EXPECT_GT(mixed_people, people / 200);
}

}  // namespace
}  // namespace holdfast::simulation
