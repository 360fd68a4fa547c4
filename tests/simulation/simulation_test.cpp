#include "simulation/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/simulation/support.hpp"

namespace holdfast::simulation {
namespace {

using testing::event;
using ::testing::HasSubstr;
using testing::Log;
using testing::make;
using testing::noise_free;
using testing::record;

SimulationOptions office(std::uint64_t seed, int threads) {
  SimulationOptions options;
  options.scenario = "office";
  options.seed = seed;
  options.duration_s = 2;
  options.threads = threads;
  return options;
}

std::uint64_t add(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001b3ULL;
}

std::uint64_t bits(double value) {
  std::uint64_t out = 0;
  std::memcpy(&out, &value, sizeof(out));
  return out;
}

std::uint64_t hash_of(const Log& log) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const ImuSample& s : log.imu) {
    hash = add(hash, static_cast<std::uint64_t>(s.t));
    for (int k = 0; k < 3; ++k) hash = add(add(hash, bits(s.gyro_rad_s[k])), bits(s.accel_m_s2[k]));
  }
  for (const Scan& scan : log.scans) {
    hash = add(add(hash, static_cast<std::uint64_t>(scan.stamp)),
               static_cast<std::uint64_t>(scan.end_time));
    for (const ScanPoint& p : scan.points) {
      for (const float v : {p.x, p.y, p.z, p.intensity}) hash = add(hash, bits(v));
      hash = add(add(hash, static_cast<std::uint64_t>(p.time_offset_ns)), p.ring);
    }
  }
  return hash;
}

TEST(Simulation, HasTheSameBitsForAnyNumberOfThreads) {
  const std::uint64_t one = hash_of(record(*make(office(1, 1))));
  EXPECT_EQ(one, hash_of(record(*make(office(1, 1)))));
  EXPECT_EQ(one, hash_of(record(*make(office(1, 2)))));
  EXPECT_EQ(one, hash_of(record(*make(office(1, 3)))));
}

TEST(Simulation, HasTheSameBitsInHardWorldsForAnyNumberOfThreads) {
  const auto hard = [](int threads) {
    SimulationOptions options = office(1, threads);
    options.changed_share = 0.3;
    options.wobble_rad = 0.05;
    options.speed_factor = 2;
    options.lidar.range_sigma_m = 0.05;
    return make(options);
  };
  const std::uint64_t one = hash_of(record(*hard(1)));
  EXPECT_EQ(one, hash_of(record(*hard(2))));
  EXPECT_NE(one, hash_of(record(*make(office(1, 1)))));
  EXPECT_EQ(hard(1)->survey_map().points, hard(2)->survey_map().points);
}

TEST(Simulation, IsAnotherForEachSeed) {
  EXPECT_NE(hash_of(record(*make(office(1, 1)))), hash_of(record(*make(office(2, 1)))));
}

TEST(Simulation, StreamsInOrderOfEndTimeAndTheImuCoversTheLastScan) {
  const auto simulation = make(office(3, 2));
  TimeNs last = simulation->start_time();
  TimeNs last_imu = 0;
  TimeNs last_scan = 0;
  std::size_t scans = 0;
  double progress = 0;
  while (true) {
    const auto next = *simulation->next();
    if (!next) break;
    const bool is_scan = std::holds_alternative<Scan>(*next);
    const TimeNs t = is_scan ? std::get<Scan>(*next).end_time : std::get<ImuSample>(*next).t;
    ASSERT_GE(t, last);
    ASSERT_GE(simulation->progress(), progress);
    progress = simulation->progress();
    last = t;
    (is_scan ? last_scan : last_imu) = t;
    scans += is_scan ? 1 : 0;
  }
  EXPECT_EQ(last_imu, simulation->start_time() + 2 * kSecond);
  EXPECT_EQ(last_imu, simulation->end_time());
  EXPECT_GE(last_imu, last_scan);
  EXPECT_EQ(scans, simulation->scan_count());
  EXPECT_EQ(scans, 19U);
  EXPECT_EQ(progress, 1.0);
}

TEST(Simulation, ImuSamplesComeEveryFiveMillisecondsFromTheStart) {
  const auto simulation = make(office(1, 2));
  const auto log = record(*simulation);
  for (std::size_t i = 0; i < log.imu.size(); ++i) {
    ASSERT_EQ(log.imu[i].t, simulation->start_time() + static_cast<TimeNs>(i) * 5'000'000);
  }
  EXPECT_GT(simulation->start_time(), 1'600'000'000 * kSecond) << "a time of our days";
}

TEST(Simulation, TruthHasTheImuTimesAndAgreesWithTheState) {
  const auto simulation = make(office(1, 2));
  const auto truth = simulation->truth();
  ASSERT_EQ(truth.size(), 401U);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_EQ(truth[i].t, simulation->start_time() + static_cast<TimeNs>(i) * 5'000'000);
    ASSERT_EQ(truth[i].T_map_body.translation, simulation->truth_at(truth[i].t).translation);
  }
}

TEST(Simulation, InitialPoseIsTheTruthAtTheFirstScansEnd) {
  const auto simulation = make(office(1, 2));
  const SE3 before = simulation->initial_pose();
  const auto log = record(*simulation);
  EXPECT_EQ(before.translation, simulation->truth_at(log.scans[0].end_time).translation);
  EXPECT_EQ(simulation->initial_pose().translation, before.translation);
}

TEST(Simulation, BlindScansAreEmptyInTheIntervalOnly) {
  SimulationOptions options = noise_free("box", 6);
  options.events = {event("blind@2.35+1.5")};
  const auto simulation = make(options);
  const auto log = record(*simulation);
  const TimeNs begin = simulation->start_time() + 2'350'000'000;
  const TimeNs end = begin + 1'500'000'000;
  std::size_t empty = 0;
  std::size_t full = 0;
  for (const Scan& scan : log.scans) {
    if (scan.points.empty()) {
      ++empty;
      EXPECT_EQ(scan.end_time, scan.stamp + kSecond / 10);
      EXPECT_TRUE(scan.stamp >= begin && scan.end_time <= end);
    }
    full += scan.points.size() == 28800 ? 1 : 0;
    for (const ScanPoint& point : scan.points) {
      const TimeNs t = scan.stamp + point.time_offset_ns;
      ASSERT_TRUE(t < begin || t >= end);
    }
  }
  EXPECT_EQ(empty, 14U);
  EXPECT_EQ(full, log.scans.size() - 14 - 2) << "two scans are cut by the interval's ends";
  ASSERT_EQ(simulation->events().size(), 1U);
  EXPECT_EQ(simulation->events()[0].t0, begin);
  EXPECT_EQ(simulation->events()[0].t1, end);
}

TEST(Simulation, WithLidarOffNoRevolutionOfTheIntervalIsAMessage) {
  SimulationOptions options = noise_free("box", 6);
  const auto all = record(*make(options));
  options.events = {event("lidar_off@2.35+1.5")};
  const auto simulation = make(options);
  const auto log = record(*simulation);
  const TimeNs begin = simulation->start_time() + 2'350'000'000;
  const TimeNs end = begin + 1'500'000'000;
  std::size_t kept = 0;
  for (const Scan& scan : all.scans) {
    const bool silent = scan.end_time > begin && scan.stamp < end;
    if (silent) continue;
    ASSERT_LT(kept, log.scans.size());
    EXPECT_EQ(log.scans[kept].stamp, scan.stamp);
    EXPECT_EQ(log.scans[kept].points.size(), scan.points.size()) << "and nothing else differs";
    ++kept;
  }
  EXPECT_EQ(kept, log.scans.size());
  EXPECT_EQ(kept, simulation->scan_count());
  EXPECT_EQ(kept, all.scans.size() - 16) << "14 within, one cut off at each end";
  EXPECT_EQ(log.imu.size(), all.imu.size());
  ASSERT_EQ(simulation->events().size(), 1U);
  EXPECT_EQ(simulation->events()[0].t0, begin);
  EXPECT_EQ(simulation->events()[0].t1, end);
}

TEST(Simulation, InitialPoseIsThatOfTheFirstMessage) {
  SimulationOptions options = noise_free("box", 6);
  options.events = {event("lidar_off@0+1.2")};
  const auto simulation = make(options);
  const SE3 initial = simulation->initial_pose();
  const auto log = record(*simulation);
  EXPECT_EQ(initial.translation, simulation->truth_at(log.scans[0].end_time).translation);
}

TEST(Simulation, WithImuOffItsSamplesAreMissingAndTheOthersStayAsTheyWere) {
  SimulationOptions options;
  options.scenario = "box";
  options.duration_s = 6;
  options.lidar.columns = 1;
  const auto all = record(*make(options));
  options.events = {event("imu_off@1.5+0.5"), event("imu_off@5.5+9")};
  const auto simulation = make(options);
  const auto log = record(*simulation);
  std::size_t kept = 0;
  for (const ImuSample& sample : all.imu) {
    const TimeNs t = sample.t - simulation->start_time();
    const bool off = (t >= 1'500'000'000 && t < 2'000'000'000) || t >= 5'500'000'000;
    if (off) continue;
    ASSERT_LT(kept, log.imu.size());
    ASSERT_EQ(log.imu[kept].t, sample.t);
    ASSERT_EQ(log.imu[kept].gyro_rad_s, sample.gyro_rad_s);
    ++kept;
  }
  EXPECT_EQ(kept, log.imu.size());
  EXPECT_EQ(kept, all.imu.size() - 100 - 101);
  EXPECT_EQ(log.scans.size(), all.scans.size());
  EXPECT_EQ(simulation->events().at(1).t1, simulation->end_time()) << "events end with the log";
  EXPECT_EQ(simulation->progress(), 1.0);
}

TEST(Simulation, BiasJumpStepsTheMeasurementsAtItsTime) {
  SimulationOptions options = noise_free("box", 6);
  options.lidar.columns = 1;
  const auto quiet = record(*make(options));
  options.events = {event("imu_bias_jump@3")};
  const auto simulation = make(options);
  const auto log = record(*simulation);
  const SimulatedEvent& jump = simulation->events().at(0);
  EXPECT_NEAR(jump.gyro_step_rad_s.norm(), 0.03, 1e-12);
  EXPECT_NEAR(jump.accel_step_m_s2.norm(), 0.3, 1e-12);
  for (std::size_t i = 0; i < log.imu.size(); ++i) {
    const double on = log.imu[i].t >= jump.t0 ? 1 : 0;
    const Eigen::Vector3d gyro = log.imu[i].gyro_rad_s - quiet.imu[i].gyro_rad_s;
    const Eigen::Vector3d accel = log.imu[i].accel_m_s2 - quiet.imu[i].accel_m_s2;
    ASSERT_NEAR((gyro - on * jump.gyro_step_rad_s).norm(), 0, 1e-12);
    ASSERT_NEAR((accel - on * jump.accel_step_m_s2).norm(), 0, 1e-12);
  }
  EXPECT_EQ(simulation->state_at(jump.t0 - 1).gyro_bias.norm(), 0);
  EXPECT_EQ(simulation->state_at(jump.t0).gyro_bias, jump.gyro_step_rad_s);
}

TEST(Simulation, KidnapPutsTwoLinesWithOneStampIntoTheTruth) {
  for (const char* when : {"kidnap@5", "kidnap@5.0013"}) {  // on an IMU sample and between two
    SimulationOptions options = noise_free("corridor", 8);
    options.events = {event(when)};
    const auto simulation = make(options);
    const SimulatedEvent kidnap = simulation->events().at(0);
    const auto truth = simulation->truth();
    std::size_t doubles = 0;
    for (std::size_t i = 1; i < truth.size(); ++i) {
      ASSERT_GE(truth[i].t, truth[i - 1].t);
      const double step =
          (truth[i].T_map_body.translation - truth[i - 1].T_map_body.translation).norm();
      if (truth[i].t > truth[i - 1].t) {
        ASSERT_LT(step, 0.01) << "continuous between stamps";
        continue;
      }
      ++doubles;
      EXPECT_EQ(truth[i].t, kidnap.t0);
      EXPECT_EQ(truth[i - 1].T_map_body.translation, kidnap.pose_before.translation);
      EXPECT_EQ(truth[i].T_map_body.translation, kidnap.pose_after.translation);
    }
    EXPECT_EQ(doubles, 1U) << when;
  }
}

TEST(Simulation, KidnapLeavesNoTraceInTheImu) {
  SimulationOptions options = noise_free("hall", 12);
  options.lidar.columns = 1;
  options.events = {event("kidnap@8.0025")};
  const auto simulation = make(options);
  const auto log = record(*simulation);
  for (std::size_t i = 1; i < log.imu.size(); ++i) {
    // Ordinary motion changes by less than 50 m/s^3 and 20 rad/s^2 (see the tests of Drive).
    ASSERT_LT((log.imu[i].accel_m_s2 - log.imu[i - 1].accel_m_s2).norm(), 0.25);
    ASSERT_LT((log.imu[i].gyro_rad_s - log.imu[i - 1].gyro_rad_s).norm(), 0.1);
  }
}

TEST(Simulation, SaysWhatIsWrongWithItsOptions) {
  const auto message = [](const SimulationOptions& options) {
    const auto simulation = Simulation::create(options);
    return simulation ? std::string("created") : simulation.error().message;
  };
  SimulationOptions options;
  options.scenario = "moon";
  EXPECT_THAT(message(options), HasSubstr("unknown scenario 'moon'"));
  options = noise_free("box", 10);
  options.events = {event("kidnap@10")};
  EXPECT_THAT(message(options), HasSubstr("kidnap at 10 s: expected a start within the log"));
  options = noise_free("box", 0);
  EXPECT_THAT(message(options), HasSubstr("duration"));
  options = noise_free("box", 10);
  options.imu.rate_hz = 300;
  EXPECT_THAT(message(options), HasSubstr("imu rate"));
  options = noise_free("box", 10);
  options.lidar.beams.clear();
  EXPECT_THAT(message(options), HasSubstr("beams"));
  const auto refuses = [&](const char* about, const auto& spoil) {
    SimulationOptions spoilt = noise_free("office", 10);
    spoil(spoilt);
    EXPECT_THAT(message(spoilt), HasSubstr(about));
  };
  refuses("120 % of the world changed: expected 0 to 100", [](auto& o) { o.changed_share = 1.2; });
  refuses("0 times the speed: expected 0.1 to 10", [](auto& o) { o.speed_factor = 0; });
  refuses("degrees: expected 0 to 30", [](auto& o) { o.wobble_rad = 1; });
  refuses("range noise of -1 m: expected", [](auto& o) { o.lidar.range_sigma_m = -1; });
  refuses("map noise of nan m: expected", [](auto& o) { o.map_sigma_m = NAN; });
  EXPECT_THAT(message(noise_free("box", 10)), "created");
}

}  // namespace
}  // namespace holdfast::simulation
