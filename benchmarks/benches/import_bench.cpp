#include <fmt/format.h>

#include <array>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/drives/town_cloud.hpp"
#include "benchmarks/harness/child_process.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/log_file.hpp"
#include "holdfast/io/tum_file.hpp"
#include "holdfast/places/place_maker.hpp"
#include "simulation/log_output.hpp"

namespace holdfast::benchmarks {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kPoints = 2'000'000;
constexpr int kImports = 3;

/// What the processes of one measurement share on disk.
struct Files {
  std::filesystem::path cloud, bag, config, truth, map;

  explicit Files(const ScratchFolder& scratch)
      : cloud(scratch / "town.pcd"),
        bag(scratch / "run.bag"),
        config(scratch / "config.yaml"),
        truth(scratch / "truth.tum"),
        map(scratch / "map") {}
};

/// Writes the town, and a drive through its warehouse.
Result<ordered_json> prepare(const DriveSpec& spec, const Files& files) {
  auto drive = make_drive(spec);
  if (!drive) return drive.error();
  simulation::Simulation& simulation = **drive;
  const std::string config = simulation::robot_config(simulation);
  if (auto done = io::write_file_atomically(files.config, config); !done) return done.error();
  if (auto done = io::write_tum(files.truth, simulation.truth()); !done) return done.error();
  if (auto done = record_bag(simulation, files.bag); !done) return done.error();
  auto town = make_town(kPoints, simulation, spec.threads);
  if (!town) return town.error();
  if (auto done = io::write_cloud(files.cloud, *town); !done) return done.error();
  const SE3 pose = simulation.initial_pose();
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return ordered_json{{"initial_pose", {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}}};
}

/// What `holdfast map import` does.
Result<ordered_json> import(const Files& files, int threads) {
  const double begin = wall_ms();
  auto cloud = io::read_cloud(files.cloud);
  if (!cloud) return cloud.error();
  const double read = wall_ms();
  WorkerPool pool(threads);
  const auto info =
      places::build_map({std::move(*cloud), std::nullopt, "town.pcd"}, files.map, pool);
  if (!info) return info.error();
  std::uint64_t bytes = 0;
  for (const map::TileInfo& tile : info->tiles) bytes += tile.bytes;
  return ordered_json{{"wall_s", 1e-3 * (wall_ms() - begin)},
                      {"read_s", 1e-3 * (read - begin)},
                      {"points", info->points},
                      {"tiles", info->tiles.size()},
                      {"surfaces_mb", 1e-6 * static_cast<double>(bytes)}};
}

/// What `holdfast localize` does up to its report.
Result<ordered_json> localize_in_town(const Files& files, const std::array<double, 7>& start) {
  const auto config = pipeline::load_config(files.config, {});
  if (!config) return config.error();
  const auto truth = io::read_tum(files.truth);
  if (!truth) return truth.error();
  auto log = io::open_log(files.bag, {});
  if (!log) return log.error();
  const SE3 initial_pose{{start[3], start[4], start[5], start[6]}, {start[0], start[1], start[2]}};
  const auto steps = localize(**log, *config, files.map, initial_pose);
  if (!steps) return steps.error();
  const auto e = judge(*steps, *truth);
  if (!e) return e.error();
  std::vector<double> step_ms;
  for (const StepReport& step : *steps) step_ms.push_back(step.times.total_ms);
  return ordered_json{{"scans", e->scans},
                      {"claimed", e->claimed},
                      {"ate_rmse_m", known(e->trans_m.rmse)},
                      {"step_ms", json_of(distribution_of(step_ms))}};
}

struct Outcome {
  std::vector<double> import_wall_s, import_cpu_s, import_rss_mb;
  ordered_json import;  ///< of the last import
  ChildOutcome localization;
};

Result<Outcome> measure_all(const BenchOptions& options, const Files& files) {
  Outcome outcome;
  options.progress(0.0, "surveying the town");
  const DriveSpec spec{"warehouse", options.seeds.first, options.duration_s, options.threads};
  const auto prepared = run_in_child([&] { return prepare(spec, files); });
  if (!prepared) return prepared.error();
  for (int i = 0; i < kImports; ++i) {
    options.progress(0.6 + 0.1 * i, "importing");
    const auto imported = run_in_child([&] { return import(files, options.threads); });
    if (!imported) return imported.error();
    outcome.import = imported->answer;
    outcome.import_wall_s.push_back(imported->answer["wall_s"].get<double>());
    outcome.import_cpu_s.push_back(imported->cpu_s);
    outcome.import_rss_mb.push_back(imported->peak_rss_mb);
  }
  options.progress(0.9, "localizing");
  const auto start = prepared->answer["initial_pose"].get<std::array<double, 7>>();
  auto localized = run_in_child([&] { return localize_in_town(files, start); });
  if (!localized) return localized.error();
  outcome.localization = std::move(*localized);
  return outcome;
}

double largest(const std::vector<double>& values) { return evaluation::quantile(values, 1.0); }

ordered_json json_of(const Outcome& o) {
  ordered_json j;
  j["import"]["points"] = o.import["points"];
  j["import"]["tiles"] = o.import["tiles"];
  j["import"]["surfaces_mb"] = o.import["surfaces_mb"];
  j["import"]["runs"] = kImports;
  j["import"]["wall_s"] = {{"median", evaluation::median(o.import_wall_s)},
                           {"worst", largest(o.import_wall_s)}};
  j["import"]["cpu_s"] = {{"median", evaluation::median(o.import_cpu_s)},
                          {"worst", largest(o.import_cpu_s)}};
  j["import"]["peak_rss_mb"] = largest(o.import_rss_mb);
  j["localize"] = o.localization.answer;
  j["localize"]["cpu_s"] = o.localization.cpu_s;
  j["localize"]["peak_rss_mb"] = o.localization.peak_rss_mb;
  return j;
}

std::string markdown_of(const Outcome& o, const BenchOptions& options) {
  using namespace evaluation;
  const ordered_json& run = o.localization.answer;
  Table table({"what", "wall time", "CPU time", "peak memory"});
  table.add_row(
      {fmt::format("import of {} points, {} threads (median of {}; memory: worst)",
                   count_text(o.import["points"].get<double>()), options.threads, kImports),
       seconds_text(median(o.import_wall_s)), seconds_text(median(o.import_cpu_s)),
       memory_text(largest(o.import_rss_mb))});
  table.add_row({fmt::format("localization of {} scans in it, reading of the bag included",
                             run["scans"].get<std::size_t>()),
                 "-", seconds_text(o.localization.cpu_s), memory_text(o.localization.peak_rss_mb)});
  const auto rmse = run["ate_rmse_m"];
  return table.markdown() +
         fmt::format(
             "\nThe cloud: a simulated warehouse, with corridors, offices and halls beside "
             "it until there are 2 million points, about 6 cm apart. Import reads the PCD "
             "file and writes the map. The drive goes through the warehouse (ATE RMSE {}). "
             "Memory: largest resident set, mapped files included.\n",
             length_text(rmse.is_null() ? kNotKnown : rmse.get<double>()));
}

}  // namespace

Result<BenchReport> measure_import(const BenchOptions& options) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto outcome = measure_all(options, Files(*scratch));
  if (!outcome) return outcome.error();
  BenchReport report;
  report.data["results"] = json_of(*outcome);
  report.markdown = markdown_of(*outcome, options);
  return report;
}

}  // namespace holdfast::benchmarks
