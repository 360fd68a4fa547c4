#include "benchmarks/drives/cloud_scenario.hpp"

#include <cmath>
#include <cstdlib>

#include "holdfast/core/random.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "simulation/clouds/cloud_discs.hpp"
#include "simulation/files/world_file.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::benchmarks {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kSpacing = 0.2;  // metres
constexpr double kNoise = 0.03;
constexpr double kPitch = 40;  // of the blocks
constexpr double kBlock = 20;  // their width
constexpr double kHeight = 10;
constexpr double kThinning = 0.1;  // as `- cloud:` has it by default

/// Points over a rectangle from `corner` along the axes `u` and `v`.
class Face {
 public:
  Face(std::vector<Vector3f>& points, RandomStream& random) : points_(points), random_(random) {}

  template <class Keep>
  void add(const Vector3d& corner, const Vector3d& u, const Vector3d& v, const Keep& keep) {
    const Vector3d normal = u.cross(v).normalized();
    for (double a = 0.5 * kSpacing; a < u.norm(); a += kSpacing) {
      for (double b = 0.5 * kSpacing; b < v.norm(); b += kSpacing) {
        const double x = a + kSpacing * random_.uniform(-0.3, 0.3);
        const double y = b + kSpacing * random_.uniform(-0.3, 0.3);
        const Vector3d p = corner + x * u.normalized() + y * v.normalized();
        if (keep(p)) points_.push_back((p + kNoise * random_.normal() * normal).cast<float>());
      }
    }
  }

 private:
  std::vector<Vector3f>& points_;
  RandomStream& random_;
};

/// How far into its cell of the town a place lies.
double in_cell(double x) { return x - kPitch * std::floor(x / kPitch); }
bool is_built(const Vector3d& p) { return in_cell(p.x()) > kBlock && in_cell(p.y()) > kBlock; }

void add_block(Face& face, const Vector3d& corner) {
  const Vector3d x(kBlock, 0, 0), y(0, kBlock, 0), z(0, 0, kHeight);
  const auto all = [](const Vector3d&) { return true; };
  face.add(corner, x, z, all);
  face.add(corner + y, x, z, all);
  face.add(corner, y, z, all);
  face.add(corner + x, y, z, all);
  face.add(corner + z, x, y, all);
}

}  // namespace

std::vector<Vector3f> block_town(int columns, int rows) {
  std::vector<Vector3f> points;
  RandomStream random(1, "bench.town");
  Face face(points, random);
  face.add(Vector3d::Zero(), {columns * kPitch + kBlock, 0, 0}, {0, rows * kPitch + kBlock, 0},
           [](const Vector3d& p) { return !is_built(p); });
  for (int i = 0; i < columns; ++i) {
    for (int k = 0; k < rows; ++k) {
      add_block(face, {i * kPitch + kBlock, k * kPitch + kBlock, 0});
    }
  }
  return points;
}

Result<CloudScenario> cloud_scenario_of(const std::vector<Vector3f>& points, int threads) {
  CloudScenario out;
  out.scenario.name = "cloud";
  const double begin = wall_ms();
  WorkerPool pool(threads);
  const simulation::CloudDiscs discs = simulation::discs_of(points, kThinning, pool);
  simulation::WorldBuilder build;
  for (const auto& disc : discs.surfaces) build.disc(disc, simulation::materials::kConcrete);
  for (const auto& disc : discs.scattered) build.disc(disc, simulation::materials::kFoliage);
  out.scenario.world = build.build();
  out.discs_s = 1e-3 * (wall_ms() - begin);
  if (auto found = simulation::find_way(out.scenario); !found) return found.error();
  out.way_s = 1e-3 * (wall_ms() - begin) - out.discs_s;
  return out;
}

Result<CloudScenario> make_cloud_scenario(int threads) {
  const char* data = std::getenv("HOLDFAST_DATA");
  const auto file = std::filesystem::path(data == nullptr ? "" : data) / "utd_campus_west/map.pcd";
  if (data == nullptr || !std::filesystem::exists(file)) {
    return cloud_scenario_of(block_town(8, 6), threads);
  }
  const auto cloud = io::read_cloud(file);
  if (!cloud) return cloud.error();
  auto out = cloud_scenario_of(cloud->points, threads);
  if (out) out->file = file;
  return out;
}

}  // namespace holdfast::benchmarks
