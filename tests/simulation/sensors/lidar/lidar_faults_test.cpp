#include "simulation/sensors/lidar/lidar_faults.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numbers>

#include "simulation/sensors/lidar/lidar_file.hpp"
#include "simulation/sensors/lidar/returns/link_budget.hpp"
#include "tests/simulation/sensors/lidar/still_lidar.hpp"

namespace holdfast::simulation {
namespace {

using testing::make;
using testing::noise_free;
using testing::position;
using testing::record;
using testing::still_at;
using testing::still_options;

using Change = void (*)(LidarFaults&);

bool same_points(const std::vector<Scan>& a, const std::vector<Scan>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].stamp != b[i].stamp || a[i].end_time != b[i].end_time) return false;
    if (a[i].points.size() != b[i].points.size()) return false;
    for (std::size_t k = 0; k < a[i].points.size(); ++k) {
      const ScanPoint& p = a[i].points[k];
      const ScanPoint& q = b[i].points[k];
      const bool same = p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity &&
                        p.time_offset_ns == q.time_offset_ns && p.ring == q.ring;
      if (!same) return false;
    }
  }
  return true;
}

SimulationOptions office(const LidarFaults& faults, int threads = 1) {
  SimulationOptions options;
  options.scenario = "office";
  options.duration_s = 1;
  options.threads = threads;
  options.lidar.faults = faults;
  return options;
}

/// Of a fault that is on, but so small that it can change nothing.
LidarFaults all_but_nothing() {
  LidarFaults faults;
  faults.dropout_share = 1e-300;
  return faults;
}

TEST(LidarFaults, AreOffUnlessAskedFor) {
  EXPECT_TRUE(LidarFaults().none());
  EXPECT_TRUE(LidarModel::rs16().faults.none());
  EXPECT_FALSE(LidarFaults::usual().none());
  for (const std::string_view name : lidar_names()) {
    EXPECT_TRUE(make_lidar(std::string(name))->faults.none()) << name;
  }
}

// The way of a LiDAR with faults ends in the same bits as that of one without, where they do
// nothing; that the latter's are those of earlier versions follows from the tables of results.
TEST(LidarFaults, ThatDoNothingLeaveEveryBit) {
  const auto plain = record(*make(office(LidarFaults()))).scans;
  EXPECT_TRUE(same_points(plain, record(*make(office(all_but_nothing()))).scans));
  EXPECT_FALSE(same_points(plain, record(*make(office(LidarFaults::usual()))).scans));
}

TEST(LidarFaults, EachHasAStreamOfItsOwn) {
  LidarFaults one = all_but_nothing();
  one.dropout_share = 0.1;
  const auto lost = record(*make(office(one))).scans;
  const auto plain = record(*make(office(LidarFaults()))).scans;
  std::size_t k = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < lost.size(); ++i, k = 0) {
    const TimeNs late = lost[i].stamp - plain[i].stamp;
    for (const ScanPoint& p : lost[i].points) {
      const auto& all = plain[i].points;
      while (k < all.size() && all[k].time_offset_ns < p.time_offset_ns + late) ++k;
      ASSERT_LT(k, all.size());
      ASSERT_EQ(p.x, all[k].x) << "drop-outs change no range";
      ++found;
    }
  }
  EXPECT_GT(found, 100000U);
}

TEST(LidarFaults, HaveTheSameBitsForAnyNumberOfThreads) {
  const auto hard = [](int threads) {
    SimulationOptions options = office(LidarFaults::usual(), threads);
    options.weather = {20, 100};
    return record(*make(options)).scans;
  };
  const auto one = hard(1);
  EXPECT_TRUE(same_points(one, hard(2)));
  EXPECT_TRUE(same_points(one, hard(8)));
}

/// Residuals by range and incidence, in units of the standard deviation that the law gives.
struct NoiseBin {
  double squares = 0, n = 0, least = 1e9, most = 0;
};

TEST(LidarFaults, NoiseGrowsWithRangeAndIncidenceAsStated) {
  SimulationOptions options = still_options(2);
  const Eigen::Vector3d at(2, 3, 1.5);
  const auto world = [] { return testing::room_with_wall(materials::kIdeal); };
  const auto exact = record(*make(still_at(at, world()), options)).scans;
  options.lidar.range_sigma_m = 0.01;
  options.lidar.faults.range_noise_per_m = 0.002;
  options.lidar.faults.incidence_noise = 4;
  options.lidar.faults.most_range_sigma_m = 0.06;
  const auto simulation = make(still_at(at, world()), options);
  const auto noisy = record(*simulation).scans;
  const SE3 T_map_lidar = simulation->truth_at(noisy[0].stamp);
  std::array<NoiseBin, 12> bins;  // [range in steps of 3 m][tangent below 1, 3, more]
  for (std::size_t s = 0; s < exact.size(); ++s) {
    ASSERT_EQ(exact[s].points.size(), noisy[s].points.size());
    for (std::size_t i = 0; i < exact[s].points.size(); ++i) {
      const double r = position(exact[s].points[i]).norm();
      const Eigen::Vector3d p = T_map_lidar * position(exact[s].points[i]);
      const Eigen::Vector3d ray = (p - T_map_lidar.translation) / r;
      const Eigen::Vector3d off =
          (p - Eigen::Vector3d(6, 4, 2))
              .cwiseQuotient(Eigen::Vector3d(6, 4, 2));  // on the walls one is 1 or -1
      Eigen::Index wall = 0;
      off.cwiseAbs().maxCoeff(&wall);
      const double tangent = std::tan(std::acos(std::abs(ray[wall])));
      const double sigma = std::min(
          0.06, std::hypot(0.01, 0.002 * r, 4 * r * options.lidar.divergence_rad / 4 * tangent));
      const std::size_t k =
          std::min<std::size_t>(static_cast<std::size_t>(r / 3), 3) * 3 + (tangent < 1   ? 0
                                                                           : tangent < 3 ? 1
                                                                                         : 2);
      const double e = (position(noisy[s].points[i]).norm() - r) / sigma;
      bins[k].squares += e * e;
      bins[k].n += 1;
      bins[k].least = std::min(bins[k].least, sigma);
      bins[k].most = std::max(bins[k].most, sigma);
    }
  }
  double least = 1e9;
  double most = 0;
  for (const NoiseBin& bin : bins) {
    if (bin.n < 1000) continue;
    EXPECT_NEAR(bin.squares / bin.n, 1, tolerances::variance_error(bin.n));
    least = std::min(least, bin.least);
    most = std::max(most, bin.most);
  }
  EXPECT_LT(least, 0.013);
  EXPECT_EQ(most, 0.06) << "the cap is met";
}

TEST(LidarFaults, DropOutsComeAsOftenAsConfigured) {
  SimulationOptions options = still_options(4);
  options.lidar.faults.dropout_share = 0.07;
  const auto simulation =
      make(still_at({5, 4, 1.5}, testing::room_with_wall(materials::kIdeal)), options);
  double n = 0;
  double kept = 0;
  for (const Scan& scan : record(*simulation).scans) {
    n += 28800;
    kept += static_cast<double>(scan.points.size());
  }
  EXPECT_NEAR(kept, 0.93 * n, tolerances::count_error(n * 0.07 * 0.93));
}

TEST(LidarFaults, ReachEndsWhereTheLinkBudgetSays) {
  EXPECT_NEAR(LinkBudget(40, 0).strength(0.1, 40), 1, tolerances::kRounding);
  EXPECT_NEAR(LinkBudget::seen_probability(1), 0.5, tolerances::kRounding);
  SimulationOptions options = still_options(4);
  const Eigen::Vector3d at(2, 3, 1.5);
  const auto world = [] { return testing::room_with_wall(materials::kIdeal); };
  const auto all = record(*make(still_at(at, world()), options)).scans;
  options.lidar.faults.limited_reach = true;
  options.lidar.reach_at_10_percent_m = 2;
  const auto some = record(*make(still_at(at, world()), options)).scans;
  const SE3 T_map_lidar = make(still_at(at, world()), options)->initial_pose();
  std::array<double, 8> expected{};
  std::array<double, 8> variance{};
  std::array<double, 8> seen{};
  for (const ScanPoint& point : all[0].points) {
    const Eigen::Vector3d ray = T_map_lidar.rotation * position(point).normalized();
    const double r = testing::room_range(T_map_lidar.translation, ray);
    const Eigen::Vector3d p = T_map_lidar.translation + r * ray;
    const Eigen::Vector3d size(12, 8, 4);
    double cosine = 0;
    for (int k = 0; k < 3; ++k) {
      const bool on_wall = std::abs(p[k]) < 1e-6 || std::abs(p[k] - size[k]) < 1e-6;
      if (on_wall) cosine = std::abs(ray[k]);
    }
    // Strength 1 is that of 10 % at 2 m: 0.5 cos / r^2 = 0.1 / 4.
    const double strength = 0.5 * cosine / (r * r) / (0.1 / 4);
    const double chance = 0.5 * (1 + std::erf(5 * (strength - 1) / std::sqrt(2)));
    const auto bin = std::min<std::size_t>(static_cast<std::size_t>(r / 1.5), 7);
    const auto scans = static_cast<double>(some.size());
    expected[bin] += scans * chance;
    variance[bin] += scans * chance * (1 - chance);
  }
  for (const Scan& scan : some) {
    for (const ScanPoint& p : scan.points) {
      seen[std::min<std::size_t>(static_cast<std::size_t>(position(p).norm() / 1.5), 7)] += 1;
    }
  }
  for (std::size_t k = 0; k < seen.size(); ++k) {
    // Rays at a bin's border may fall to either side by a rounding: some 10 of 28800 in a scan.
    const double border = 10.0 * static_cast<double>(some.size());
    EXPECT_NEAR(seen[k], expected[k], tolerances::count_error(variance[k]) + border) << k;
  }
  EXPECT_GT(seen[2], 1000);
  EXPECT_LT(seen[6], 1e-3 * seen[2]) << "the far end of the room is out of reach";
}

}  // namespace
}  // namespace holdfast::simulation
