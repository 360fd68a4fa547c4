#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "simulation/world/ray_caster.hpp"
#include "tests/simulation/imu_integration.hpp"
#include "tests/simulation/support.hpp"
#include "tests/simulation/tolerances.hpp"

/// What must hold in every scenario, whatever happens there and whoever moves the LiDAR.
namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using testing::event;
using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;

constexpr double kDuration = 8;

struct Hardship {
  std::string name;
  std::string event;  ///< none if empty
  Motion motion = Motion::kWheels;
};

std::vector<Hardship> hardships() {
  std::vector<Hardship> out = {{"nominal", ""},
                               {"handheld", "", Motion::kHandheld},
                               {"turn_on_spot", "", Motion::kTurnOnSpot},
                               {"carried", "kidnap@3+4.5"},
                               {"handheld_kidnap", "kidnap@5", Motion::kHandheld},
                               {"handheld_carried", "kidnap@3+4.5", Motion::kHandheld}};
  for (const std::string_view name : event_names()) {
    const bool crowd = name == "crowd";
    out.push_back({std::string(name), std::string(name) + (crowd ? "@3.5+2" : "@3.5")});
  }
  return out;
}

/// Two beams of the LiDAR in fewer columns; what is left covers all directions all the same.
LidarModel thin(LidarModel lidar) {
  lidar.beams = {lidar.beams[lidar.beams.size() / 4], lidar.beams[3 * lidar.beams.size() / 4]};
  lidar.columns = 300;
  return lidar;
}

SimulationOptions options_of(const std::string& scenario, const Hardship& hardship) {
  SimulationOptions options = noise_free(scenario, kDuration);
  options.lidar = thin(options.lidar);
  options.motion = hardship.motion;
  if (!hardship.event.empty()) options.events = {event(hardship.event)};
  return options;
}

/// Rates as differences of poses. Over 2 ms they leave a sixth of the third derivative * (1 ms)^2:
/// of the position below 1e3 m/s^3, of the velocity below 5e4 m/s^4 and of the angles below
/// 5e3 rad/s^3.
void expect_derivatives(const Simulation& simulation, TimeNs t) {
  constexpr TimeNs kStep = kSecond / 1000;
  constexpr double kSixth = 1e-6 / 6;
  const TrueState before = simulation.state_at(t - kStep);
  const TrueState now = simulation.state_at(t);
  const TrueState after = simulation.state_at(t + kStep);
  const double dt = 2 * to_seconds(kStep);
  const Vector3d v = (after.T_map_body.translation - before.T_map_body.translation) / dt;
  const Vector3d a = (after.v_map - before.v_map) / dt;
  const Vector3d half_back =
      so3::log(now.T_map_body.rotation.conjugate() * before.T_map_body.rotation);
  const Vector3d half_on =
      so3::log(now.T_map_body.rotation.conjugate() * after.T_map_body.rotation);
  ASSERT_LT((v - now.v_map).norm(), 1e3 * kSixth) << to_seconds(t - simulation.start_time());
  ASSERT_LT((a - now.a_map).norm(), 5e4 * kSixth) << to_seconds(t - simulation.start_time());
  ASSERT_LT(((half_on - half_back) / dt - now.omega_body).norm(), 5e3 * kSixth)
      << to_seconds(t - simulation.start_time());
}

/// Everywhere but at teleports, at which the truth has two lines with one stamp.
void expect_smooth_truth(const Simulation& simulation) {
  std::vector<TimeNs> jumps;
  for (const SimulatedEvent& event : simulation.events()) {
    if (event.kind == EventKind::kKidnap && !event.carried) jumps.push_back(event.t0);
  }
  const auto truth = simulation.truth();
  std::size_t doubles = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const double step =
        (truth[i].T_map_body.translation - truth[i - 1].T_map_body.translation).norm();
    doubles += truth[i].t == truth[i - 1].t ? 1 : 0;
    if (truth[i].t > truth[i - 1].t) {
      ASSERT_LT(step, 0.06) << "12 m/s in 5 ms";
    }
  }
  EXPECT_EQ(doubles, jumps.size());
  for (TimeNs t = simulation.start_time() + kSecond / 100;
       t < simulation.end_time() - kSecond / 100; t += kSecond / 37) {
    const bool at_jump = std::any_of(jumps.begin(), jumps.end(), [t](TimeNs jump) {
      return std::abs(jump - t) < kSecond / 100;
    });
    if (!at_jump) {
      ASSERT_NO_FATAL_FAILURE(expect_derivatives(simulation, t));
    }
  }
}

void expect_kidnaps_far(const Simulation& simulation) {
  for (const SimulatedEvent& event : simulation.events()) {
    if (event.kind != EventKind::kKidnap) continue;
    const double metres = (event.pose_after.translation - event.pose_before.translation).norm();
    const double radians =
        so3::angle_between(event.pose_after.rotation, event.pose_before.rotation);
    EXPECT_TRUE(metres >= 3 || radians >= M_PI / 4) << metres << " m, " << radians << " rad";
  }
}

double distance_to(const Capsule& shape, const Vector3d& p) {
  const Vector3d axis = shape.b - shape.a;
  const double along = std::clamp((p - shape.a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return std::abs((p - shape.a - along * axis).norm() - shape.radius);
}

/// A ray takes people's shapes from the middle of its 40 columns, 7 ms away at most, and moves a
/// leg on as a whole: of the 2.3 m/s of a quick foot it leaves half.
constexpr double kPersonSlack = 0.5 * 2.3 * 0.007 + 0.001;

bool is_on_person(const std::vector<Capsule>& shapes, const Vector3d& p) {
  return std::any_of(shapes.begin(), shapes.end(),
                     [&](const Capsule& shape) { return distance_to(shape, p) < kPersonSlack; });
}

/// Movers are carried on over 7 ms likewise, with the velocity and turning rate that they have.
constexpr double kMoverSlack = 0.001;

bool is_on_mover(const Movers& movers, TimeNs t, const Vector3d& p) {
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const Vector3d in_body = movers.at(i, t).T_map_body.inverse() * p;
    for (const BodyBox& box : movers.boxes(i)) {
      const Vector3d out = (in_body - box.center).cwiseAbs() - 0.5 * box.size;
      if (std::abs(out.maxCoeff()) < kMoverSlack) return true;
    }
  }
  return false;
}

/// Range at which a ray meets the static world.
double static_range(const RayCaster& world, const Vector3d& origin, const Vector3d& direction) {
  RayPacket rays;
  rays.x.fill(static_cast<float>(origin.x()));
  rays.y.fill(static_cast<float>(origin.y()));
  rays.z.fill(static_cast<float>(origin.z()));
  rays.dx.fill(static_cast<float>(direction.x()));
  rays.dy.fill(static_cast<float>(direction.y()));
  rays.dz.fill(static_cast<float>(direction.z()));
  HitPacket hits;
  world.cast(rays, 0.05F, 300, hits);
  return hits.range[0];
}

/// Ranges are floats in worlds of up to 250 m; a ray that grazes a surface or passes an edge within
/// that may meet what is behind.
constexpr double kRange = 12 * 250 * 6e-8;
constexpr double kGrazing = 0.002;  // share of the returns

void expect_returns_on_surfaces(const Simulation& simulation, const std::vector<Scan>& scans,
                                const RayCaster& world) {
  const SE3& T_body_lidar = simulation.options().lidar.T_body_lidar;
  std::size_t returns = 0;
  std::size_t off = 0;
  std::vector<Capsule> shapes;
  for (std::size_t i = 0; i < scans.size(); i += 4) {
    const Scan scan = simulation.in_true_time(scans[i]);
    for (const ScanPoint& point : scan.points) {
      const TimeNs t = scan.stamp + point.time_offset_ns;
      const SE3 T_map_lidar = simulation.truth_at(t) * T_body_lidar;
      const Vector3d ray = position(point);
      const Vector3d direction = T_map_lidar.rotation * ray.normalized();
      const double there = static_range(world, T_map_lidar.translation, direction);
      ++returns;
      if (std::abs(there - ray.norm()) < kRange * 10) continue;
      simulation.people().shapes_at(t - simulation.start_time(), shapes);
      const Vector3d p = T_map_lidar * ray;
      const bool moving = is_on_person(shapes, p) ||
                          is_on_mover(simulation.movers(), t - simulation.start_time(), p);
      off += moving ? 0 : 1;
    }
  }
  EXPECT_LE(static_cast<double>(off), 2 + kGrazing * static_cast<double>(returns)) << returns;
}

class EveryScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryScenario, HasAnExactTruthWhateverHappens) {
  const Scenario scenario = *make_scenario(GetParam());
  for (const Hardship& hardship : hardships()) {
    SCOPED_TRACE(hardship.name);
    auto simulation = Simulation::create(scenario, options_of(GetParam(), hardship));
    ASSERT_TRUE(simulation) << simulation.error().message;
    expect_smooth_truth(**simulation);
    expect_kidnaps_far(**simulation);
    const RayCaster world((*simulation)->scenario().world);
    expect_returns_on_surfaces(**simulation, record(**simulation).scans, world);
    EXPECT_EQ((*simulation)->events().size(), hardship.event.empty() ? 0U : 1U);
  }
}

std::vector<std::string> all_scenarios() {
  std::vector<std::string> names;
  for (const ScenarioInfo& info : scenarios()) names.emplace_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Truth, EveryScenario, ::testing::ValuesIn(all_scenarios()),
                         [](const auto& instance) { return instance.param; });

/// Greatest |d^4/dt^4| of the rates that a gesture of 0.28 rad adds (at 3 rad/s, in 0.17 s), and
/// where its third derivative sets in at once, smoothed over a knot: 720 A / T^5 + 60 A / T^3 /
/// knot^2. Being carried turns slower.
const double kGestureFourth =
    720 * 0.28 / std::pow(0.17, 5) + 60 * 0.28 / std::pow(0.17, 3) / (0.05 * 0.05);

TEST(Truth, IntegratesFromTheImuThroughCarryingAndInTheHand) {
  for (const char* scenario : {"corridor", "garage", "offices"}) {
    for (const Hardship& hardship :
         {Hardship{"carried", "kidnap@6+6"}, Hardship{"handheld", "", Motion::kHandheld}}) {
      SimulationOptions options = options_of(scenario, hardship);
      options.duration_s = 16;
      options.lidar.columns = 1;
      options.imu.rate_hz = 1000;
      const auto simulation = make(options);
      const auto log = record(*simulation);
      const TrueState begin = simulation->state_at(simulation->start_time());
      const auto end = testing::integrate(log.imu, {begin.T_map_body, begin.v_map},
                                          options.imu.gravity_map, 0.001);
      const SE3 truth = simulation->truth_at(log.imu.back().t);
      const double attitude = tolerances::integrated_attitude(16, 0.002) +
                              16 * std::pow(0.002, 4) / 2880 * kGestureFourth;
      EXPECT_LT(so3::angle_between(end.pose.rotation, truth.rotation), attitude)
          << scenario << " " << hardship.name;
      EXPECT_LT((end.pose.translation - truth.translation).norm(), 9.81 * attitude * 16 * 16 / 6)
          << scenario << " " << hardship.name;
    }
  }
}

}  // namespace
}  // namespace holdfast::simulation
