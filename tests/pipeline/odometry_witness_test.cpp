#include "holdfast/pipeline/graph/odometry_witness.hpp"

#include <gtest/gtest.h>

#include "holdfast/pipeline/event_sequencer.hpp"
#include "holdfast/pipeline/methods/odometry_run.hpp"
#include "tests/integration/drive_in_map.hpp"

namespace holdfast::pipeline {
namespace {

/// A drive whose odometry is asked about the true poses, or others.
struct DriveWithWitness {
  explicit DriveWithWitness(const std::vector<std::string>& events = {}) {
    simulation::SimulationOptions options;
    options.scenario = "office";
    options.duration_s = 14.0;
    for (const auto& event : events) options.events.push_back(*simulation::parse_event(event));
    simulation = testing::valid(simulation::Simulation::create(options));
    config = testing::config_of(*simulation);
  }

  /// Calls `on_scan(witness, true pose, time)` after each scan.
  template <class OnScan>
  void play(OnScan on_scan) {
    OdometryWitness witness(odometry_setup(config));
    EventSequencer sequencer;
    const auto drain = [&] {
      SensorEvent event;
      while (sequencer.pop(event)) {
        if (const auto* imu = std::get_if<ImuSample>(&event)) {
          witness.add_imu(*imu);
        } else {
          const TimeNs t = std::get<Scan>(event).end_time;
          witness.add_scan(std::get<Scan>(event));
          on_scan(witness, simulation->truth_at(t), t - simulation->start_time());
        }
      }
    };
    while (auto event = testing::valid(simulation->next())) {
      sequencer.push(std::move(*event));
      drain();
    }
    sequencer.finish();
    drain();
  }

  std::unique_ptr<simulation::Simulation> simulation;
  Config config;
};

MappedPose good_to_a_millimetre(const SE3& T_map_body) {
  return {T_map_body, 1e-6 * estimator::Matrix6d::Identity()};
}

// Chi-square of 6 degrees of freedom exceeds 46 once in 3 * 10^7 scans.
constexpr double kNeverByChance = 46.0;

TEST(TheOdometryWitness, AgreesWithAMapThatTellsTheTruth) {
  DriveWithWitness drive;
  int compared = 0;
  drive.play([&](OdometryWitness& witness, const SE3& truth, TimeNs t) {
    witness.compare(good_to_a_millimetre(truth));
    EXPECT_FALSE(witness.broke());
    if (!witness.way_squared_distance()) return;
    EXPECT_LT(*witness.way_squared_distance(), kNeverByChance) << to_seconds(t) << " s";
    ++compared;
  });
  EXPECT_GE(compared, 100);
}

TEST(TheOdometryWitness, IsFarFromAMapThatJumpsUntilItsWayBeginsAfterTheJump) {
  DriveWithWitness drive;
  drive.play([&](OdometryWitness& witness, SE3 T_map_body, TimeNs t) {
    if (t > 6 * kSecond) T_map_body.translation.x() += 2.0;
    witness.compare(good_to_a_millimetre(T_map_body));
    if (t > 6 * kSecond && t < 8 * kSecond - kSecond / 5) {
      ASSERT_TRUE(witness.way_squared_distance());
      // 2 m, where 3 % of at most 5 m of way and 5 cm are allowed for: above 160.
      EXPECT_GT(*witness.way_squared_distance(), 2 * kNeverByChance) << to_seconds(t) << " s";
    }
    if (t > 12 * kSecond) {
      ASSERT_TRUE(witness.way_squared_distance());
      EXPECT_LT(*witness.way_squared_distance(), kNeverByChance) << to_seconds(t) << " s";
    }
  });
}

TEST(TheOdometryWitness, SaysNothingOfTheWayWhereNobodyComparedIt) {
  DriveWithWitness drive;
  drive.play([&](OdometryWitness& witness, const SE3& truth, TimeNs t) {
    if (t < 5 * kSecond || t > 6 * kSecond) witness.compare(good_to_a_millimetre(truth));
    if (t > 5 * kSecond && t < 6 * kSecond) {
      EXPECT_FALSE(witness.way_squared_distance());
    }
  });
}

TEST(TheOdometryWitness, TellsTheMotionBetweenScansThatItSaw) {
  DriveWithWitness drive({"blind@6+1"});
  SE3 before;
  int told = 0;
  drive.play([&](OdometryWitness& witness, const SE3& truth, TimeNs t) {
    const auto motion = witness.take_motion();
    const bool blind = t > 6 * kSecond && t < 7 * kSecond;
    if (blind) {
      EXPECT_FALSE(motion) << to_seconds(t) << " s";
    }
    if (motion && t > kSecond) {
      estimator::NodeState i;
      estimator::NodeState j;
      i.T_map_body = before;
      j.T_map_body = truth;
      EXPECT_LT(motion->squared_distance(i, j), kNeverByChance) << to_seconds(t) << " s";
      ++told;
    }
    before = truth;
  });
  EXPECT_GE(told, 100);
}

TEST(TheOdometryWitness, TellsNoMotionBeforeItHasSeenTwoScans) {
  DriveWithWitness drive;
  int scans = 0;
  drive.play([&](OdometryWitness& witness, const SE3&, TimeNs) {
    const auto motion = witness.take_motion();
    if (scans++ == 0) {
      EXPECT_FALSE(motion);
    }
  });
  EXPECT_GE(scans, 100);
}

}  // namespace
}  // namespace holdfast::pipeline
