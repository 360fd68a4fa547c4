#include "benchmarks/drives/town_cloud.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "benchmarks/drives/surveyed_drive.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kSmallWorlds = {"corridor", "office", "hall"};
constexpr float kGapM = 5;     // between the warehouse and the others
constexpr float kPitchM = 55;  // of the grid: the corridor is 50 m long
constexpr std::size_t kRows = 3;

Eigen::AlignedBox3f bounds_of(const std::vector<Eigen::Vector3f>& points) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points) box.extend(p);
  return box;
}

Result<io::PointCloud> survey_small(std::size_t number, int threads) {
  const char* scenario = kSmallWorlds[number % kSmallWorlds.size()];
  auto drive = make_drive({scenario, number + 1, 1.0, threads});
  if (!drive) return drive.error();
  return (*drive)->survey_map();
}

}  // namespace

Result<io::PointCloud> make_town(std::size_t points, simulation::Simulation& warehouse,
                                 int threads) {
  io::PointCloud town = warehouse.survey_map();
  const Eigen::AlignedBox3f first = bounds_of(town.points);
  for (std::size_t number = 0; town.points.size() < points; ++number) {
    auto world = survey_small(number, threads);
    if (!world) return world.error();
    const Eigen::Vector3f low = bounds_of(world->points).min();
    const Eigen::Vector3f place(
        first.max().x() + kGapM + kPitchM * static_cast<float>(number / kRows),
        first.min().y() + kPitchM * static_cast<float>(number % kRows), low.z());
    for (const Eigen::Vector3f& p : world->points) town.points.push_back(p - low + place);
  }
  town.points.resize(points);
  return town;
}

}  // namespace holdfast::benchmarks
