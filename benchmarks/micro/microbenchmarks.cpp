#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>

#include "benchmarks/drives/closed_room.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/yardsticks/kd_tree_registration.hpp"
#include "holdfast/core/random.hpp"
#include "holdfast/map/map_builder.hpp"
#include "holdfast/preprocess/deskew.hpp"

/// Time of single kernels, per point or per pair, on a scan of 16 x 500 points in a room of known
/// shape whose map has points 6 cm apart.
namespace holdfast::benchmarks {
namespace {

constexpr double kSpacingM = 0.06;
constexpr int kBeams = 16, kColumns = 500;

template <class T>
T value_or_end(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "error: %s\n", result.error().message.c_str());
  std::exit(1);
}

/// The room's map, opened, and a scan in it.
struct Scene {
  ClosedRoom room;
  ScratchFolder scratch = value_or_end(ScratchFolder::create());
  map::PriorMap map;
  SE3 T_map_body{so3::exp({0.01, -0.02, 0.4}), {0.7, -0.4, -0.6}};
  registration::BodyPoints points = room.scan(T_map_body, kBeams, kColumns, 0.0);
  WorkerPool pool;

  Scene() : map(make_map()) { value_or_end(map.focus(T_map_body.translation, 50.0)); }

  SE3 T_anchor_body() const { return {T_map_body.rotation, T_map_body.translation - map.anchor()}; }

  static Scene& get() {
    static Scene scene;  // made once, when the first benchmark asks
    return scene;
  }

 private:
  map::PriorMap make_map() {
    map::MapSource source;
    source.cloud.points = room.surface(kSpacingM);
    source.name = "room";
    value_or_end(map::build_map(std::move(source), scratch / "map", pool));
    return value_or_end(map::PriorMap::open(scratch / "map"));
  }
};

/// Reports the time of one item beside that of the whole.
void per_item(benchmark::State& state, std::size_t items, const char* name) {
  state.counters[name] =
      benchmark::Counter(static_cast<double>(items), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void map_lookup(benchmark::State& state) {
  const Scene& scene = Scene::get();
  std::vector<Eigen::Vector3f> places;
  for (const auto& p : scene.points.points) {
    places.push_back((scene.T_anchor_body() * p.cast<double>()).cast<float>());
  }
  for (auto _ : state) {
    for (const Eigen::Vector3f& p : places) benchmark::DoNotOptimize(scene.map.find(0, p).surface);
  }
  per_item(state, places.size(), "per_point");
}
BENCHMARK(map_lookup);

void associate(benchmark::State& state) {
  Scene& scene = Scene::get();
  registration::Correspondences pairs;
  for (auto _ : state) {
    benchmark::DoNotOptimize(registration::associate(scene.map, scene.T_anchor_body(),
                                                     Eigen::Vector3d::Zero(), scene.points, {},
                                                     scene.pool, pairs));
  }
  per_item(state, scene.points.size(), "per_point");
}
BENCHMARK(associate);

void linearise(benchmark::State& state) {
  Scene& scene = Scene::get();
  registration::Correspondences pairs;
  registration::associate(scene.map, scene.T_anchor_body(), Eigen::Vector3d::Zero(), scene.points,
                          {}, scene.pool, pairs);
  std::vector<registration::NormalEquations> partials;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        registration::linearise(pairs, scene.T_anchor_body(), 3.0, scene.pool, partials));
  }
  per_item(state, pairs.size(), "per_pair");
}
BENCHMARK(linearise);

/// A tenth of a second of motion, and points spread over it.
struct MovingScan {
  preprocess::ImuSegment imu;
  std::vector<ScanPoint> points;

  MovingScan() {
    for (TimeNs t = 0; t <= kSecond / 10; t += kSecond / 200) {
      imu.samples.push_back({t, {0.1, -0.2, 0.8}, {0.3, 0.2, 9.8}});
    }
    RandomStream random(1, "microbenchmarks.points");
    const auto anywhere = [&] { return static_cast<float>(random.uniform(-20, 20)); };
    constexpr int kPoints = kBeams * kColumns;
    for (int i = 0; i < kPoints; ++i) {
      ScanPoint& p = points.emplace_back();
      p.x = anywhere();
      p.y = anywhere();
      p.z = anywhere();
      p.time_offset_ns = static_cast<std::int32_t>(kSecond / 10 / kPoints * i);
    }
  }
};

void deskew(benchmark::State& state) {
  const MovingScan scan;
  preprocess::ScanMotion motion;
  std::vector<Eigen::Vector3f> out(scan.points.size());
  for (auto _ : state) {
    motion.set(scan.imu, {{1, 0, 0}, {0, 0, -9.81}, {0, 0, 0}, {0, 0, 0}}, {}, 0, kSecond / 10);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = motion.deskew(scan.points[i]);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  per_item(state, out.size(), "per_point");
}
BENCHMARK(deskew);

/// The yardstick: one search, its fits and one solution, from the true pose.
void kd_tree_registration(benchmark::State& state) {
  Scene& scene = Scene::get();
  KdTreeOptions options;
  options.max_iterations = 1;
  KdTreeRegistration tree(scene.room.surface(kSpacingM), options);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        tree.align(scene.points, Eigen::Vector3d::Zero(), {scene.T_map_body}).pairs);
  }
  per_item(state, scene.points.size(), "per_point");
}
BENCHMARK(kd_tree_registration);

}  // namespace
}  // namespace holdfast::benchmarks
