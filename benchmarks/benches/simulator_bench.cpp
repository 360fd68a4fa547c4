#include <fmt/format.h>

#include <array>
#include <ctime>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/cloud_scenario.hpp"
#include "benchmarks/drives/surveyed_drive.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/pipeline/run_summary.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array kScenarios = {"corridor", "office", "hall", "warehouse", "yard"};

double process_cpu_s() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A simulated second cost that much.
struct Speed {
  double simulated_s = 0, wall_s = 0, cpu_s = 0;

  double realtime_factor() const { return simulated_s / wall_s; }
  /// What one core that does nothing else would reach.
  double cpu_factor() const { return simulated_s / cpu_s; }
};

Status drain(simulation::Simulation& drive) {
  while (true) {
    const auto event = drive.next();
    if (!event) return event.error();
    if (!event->has_value()) return Done{};
  }
}

/// Building the world counts for nothing: it is done once, however long the drive.
template <class Work>
Status measure(const DriveSpec& spec, const Work& work, Speed& speed) {
  auto drive = make_drive(spec);
  if (!drive) return drive.error();
  const double wall = wall_ms();
  const double cpu = process_cpu_s();
  if (Status done = work(**drive); !done) return done;
  speed.wall_s += 1e-3 * (wall_ms() - wall);
  speed.cpu_s += process_cpu_s() - cpu;
  speed.simulated_s += to_seconds((*drive)->end_time() - (*drive)->start_time());
  return Done{};
}

struct Speeds {
  Speed one_thread, threads, bag;
  Speed faults;      ///< every fault of the LiDAR
  Speed many_beams;  ///< 128 x 1024
};

Status add_drive(DriveSpec spec, Speeds& speeds) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  if (auto done = measure(spec, drain, speeds.threads); !done) return done;
  const auto record = [&](simulation::Simulation& drive) {
    return record_bag(drive, *scratch / "run.bag");
  };
  if (auto done = measure(spec, record, speeds.bag); !done) return done;
  DriveSpec other = spec;
  other.lidar.faults = simulation::LidarFaults::usual();
  if (auto done = measure(other, drain, speeds.faults); !done) return done;
  other.lidar = simulation::LidarModel::os1_128();
  if (auto done = measure(other, drain, speeds.many_beams); !done) return done;
  spec.threads = 1;
  return measure(spec, drain, speeds.one_thread);
}

nlohmann::ordered_json json_of(const Speed& speed) {
  return {{"realtime_factor", known(speed.realtime_factor())},
          {"wall_s", known(speed.wall_s)},
          {"cpu_s", known(speed.cpu_s)},
          {"simulated_s", known(speed.simulated_s)},
          {"cpu_factor", known(speed.cpu_factor())}};
}

/// A drive through a cloud of three million discs: what it costs to begin, and to go on.
Status add_cloud_row(const BenchOptions& options, BenchReport& report) {
  options.progress(1, "a cloud as a world");
  auto cloud = make_cloud_scenario(options.threads);
  if (!cloud) return cloud.error();
  simulation::SimulationOptions drive_options;
  drive_options.seed = options.seeds.first;
  drive_options.duration_s = options.duration_s;
  drive_options.threads = options.threads;
  const std::size_t discs = cloud->scenario.world.discs.size();
  const double begin = wall_ms();
  auto drive = simulation::Simulation::create(std::move(cloud->scenario), drive_options);
  if (!drive) return drive.error();
  const double tree_s = 1e-3 * (wall_ms() - begin);
  Speed speed{to_seconds((*drive)->end_time() - (*drive)->start_time()), -1e-3 * wall_ms(),
              -process_cpu_s()};
  if (Status done = drain(**drive); !done) return done;
  speed.wall_s += 1e-3 * wall_ms();
  speed.cpu_s += process_cpu_s();
  report.data["cloud"] = {{"file", cloud->file.empty() ? "" : cloud->file.filename().string()},
                          {"discs", discs},
                          {"in_process", json_of(speed)},
                          {"discs_s", known(cloud->discs_s)},
                          {"way_s", known(cloud->way_s)},
                          {"tree_s", known(tree_s)},
                          {"peak_rss_mb", known(pipeline::peak_rss_mb())}};
  report.markdown += fmt::format(
      "\nA {} of {} discs as a world: {} real time with {} threads ({} by CPU time of one "
      "core). Before it begins: {:.1f} s for the discs, {:.1f} s for a way through them, {:.1f} s "
      "for the tree; {:.0f} MB at most.\n",
      cloud->file.empty() ? "made-up town" : "recorded campus", discs,
      ratio_text(speed.realtime_factor()), options.threads, ratio_text(speed.cpu_factor()),
      cloud->discs_s, cloud->way_s, tree_s, pipeline::peak_rss_mb());
  return Done{};
}

}  // namespace

Result<BenchReport> measure_simulator(const BenchOptions& options) {
  BenchReport report;
  const std::string threads = fmt::format("{} threads", options.threads);
  Table table({"scenario", "in process, " + threads, "to a bag, " + threads, "in process, 1 thread",
               "by CPU time, 1 thread", "all LiDAR faults, " + threads, "128 x 1024, " + threads});
  double done = 0;
  for (const char* scenario : kScenarios) {
    Speeds speeds;
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      const DriveSpec spec{scenario, seed, options.duration_s, options.threads};
      options.progress(done++ / static_cast<double>(kScenarios.size() * options.seeds.count()),
                       fmt::format("{}, seed {}", scenario, seed));
      if (auto added = add_drive(spec, speeds); !added) return added.error();
    }
    report.data["results"].push_back({{"scenario", scenario},
                                      {"in_process", json_of(speeds.threads)},
                                      {"to_bag", json_of(speeds.bag)},
                                      {"in_process_1_thread", json_of(speeds.one_thread)},
                                      {"lidar_faults", json_of(speeds.faults)},
                                      {"lidar_128x1024", json_of(speeds.many_beams)}});
    table.add_row(
        {scenario, ratio_text(speeds.threads.realtime_factor()),
         ratio_text(speeds.bag.realtime_factor()), ratio_text(speeds.one_thread.realtime_factor()),
         ratio_text(speeds.one_thread.cpu_factor()), ratio_text(speeds.faults.realtime_factor()),
         ratio_text(speeds.many_beams.realtime_factor())});
  }
  report.markdown = table.markdown();
  report.markdown +=
      "\nTimes real time, by the wall clock and (by CPU time) by that of all threads, for a 16 x "
      "1800 LiDAR at 10 Hz and an IMU at 200 Hz. Then the same LiDAR with the faults of `--faults "
      "lidar`, and one of 128 x 1024 without. On two cores that do nothing else it is to be at "
      "least 20, 5 and 4.\n";
  if (auto added = add_cloud_row(options, report); !added) return added.error();
  return report;
}

}  // namespace holdfast::benchmarks
