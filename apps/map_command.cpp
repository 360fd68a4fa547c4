#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "apps/commands.hpp"
#include "apps/progress_bar.hpp"
#include "apps/run_options.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/tum_file.hpp"
#include "holdfast/map/map_builder.hpp"
#include "holdfast/map/prior_map.hpp"
#include "holdfast/pipeline/accumulate.hpp"
#include "holdfast/places/place_maker.hpp"
#include "holdfast/places/places.hpp"

namespace holdfast::apps {
namespace {

void print_info(const map::MapInfo& info, const std::string& path) {
  const Eigen::Vector3d size = info.bounds_max - info.bounds_min;
  std::uint64_t bytes = 0;
  for (const auto& tile : info.tiles) bytes += tile.bytes;
  fmt::print("map       {}\nidentity  {}\nsource    {}\n", path, info.identity, info.source);
  fmt::print("extent    {:.1f} x {:.1f} x {:.1f} m, from [{:.1f}, {:.1f}, {:.1f}]\n", size.x(),
             size.y(), size.z(), info.bounds_min.x(), info.bounds_min.y(), info.bounds_min.z());
  fmt::print("points    {}, about {:.2f} m apart on surfaces, {:.1f} mm off their planes\n",
             info.points, info.spacing_m, 1e3 * info.noise_m);
  fmt::print("gravity   [{:.4f}, {:.4f}, {:.4f}] m/s^2\n", info.gravity_map.x(),
             info.gravity_map.y(), info.gravity_map.z());
  for (const auto& level : info.levels) {
    fmt::print("surfaces  {:8} planes  {:7} lines   in cells of {:.2f} m\n", level.planes,
               level.lines, level.cell_m);
  }
  fmt::print("tiles     {} of {:.0f} m, {:.1f} MB of surfaces\n", info.tiles.size(),
             map::kTileSizeM, static_cast<double>(bytes) * 1e-6);
}

void print_places(const std::string& path) {
  const auto places = value_or_fail(places::Places::open(path));
  const auto info = value_or_fail(map::read_map_info(path));
  if (!info.places) {
    fmt::print("places    none: import the map again to make them\n");
    return;
  }
  const auto all = places.all().size();
  const auto poor = std::count_if(
      places.all().begin(), places.all().end(),
      [](const places::Place& place) { return place.weakest_sigma_m > places::kPoorSigmaM; });
  fmt::print("places    {}, {:.1f} kB; {:.1f} % of them poorly localizable (> {:.0f} mm)\n", all,
             1e-3 * static_cast<double>(info.places->bytes),
             all == 0 ? 0.0 : 100.0 * static_cast<double>(poor) / static_cast<double>(all),
             1e3 * places::kPoorSigmaM);
}

struct ImportArguments {
  std::string cloud, edges, planes, out;
  int threads = 2;
};

map::MapSource read_source(const ImportArguments& args) {
  map::MapSource source;
  const bool features = !args.edges.empty() || !args.planes.empty();
  if (features == !args.cloud.empty() || args.edges.empty() != args.planes.empty()) {
    throw CommandFailed{2, "give either one CLOUD, or --edges and --planes together"};
  }
  source.cloud = value_or_fail(io::read_cloud(features ? args.planes : args.cloud));
  if (features) source.edges = value_or_fail(io::read_cloud(args.edges));
  source.name = std::filesystem::path(features ? args.planes : args.cloud).filename().string();
  if (features) source.name += " + " + std::filesystem::path(args.edges).filename().string();
  return source;
}

void make_map(map::MapSource source, const std::string& out, int threads) {
  const auto begin = std::chrono::steady_clock::now();
  WorkerPool pool(threads);
  ProgressBar fitting("fitting surfaces");
  std::optional<ProgressBar> looking;
  const auto update = [](ProgressBar& bar, std::size_t done, std::size_t all, const char* what) {
    bar.update(static_cast<double>(done) / static_cast<double>(all),
               fmt::format("{} of {} {}", done, all, what));
  };
  const auto info = value_or_fail(places::build_map(
      std::move(source), out, pool,
      [&](std::size_t done, std::size_t all) { update(fitting, done, all, "tiles"); },
      [&](std::size_t done, std::size_t all) {
        if (!looking) looking.emplace("places");
        update(*looking, done, all, "viewpoints");
      }));
  looking.reset();
  print_info(info, out);
  print_places(out);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  fmt::print("made in   {:.2f} s\n", elapsed.count());
}

void add_import(CLI::App& map) {
  auto* command = map.add_subcommand("import", "make a map from a point cloud");
  auto args = std::make_shared<ImportArguments>();
  command->add_option("cloud", args->cloud, "cloud in the map frame (.pcd or .ply)");
  command->add_option("--edges", args->edges,
                      "cloud of edge points, with --planes instead of CLOUD");
  command->add_option("--planes", args->planes, "cloud of planar points");
  command->add_option("--out", args->out, "folder of the map")->required();
  command->add_option("--threads", args->threads, "threads; the map does not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->callback([args] { make_map(read_source(*args), args->out, args->threads); });
}

struct BuildArguments {
  std::vector<std::string> logs;
  std::string poses, out;
  RunOptions run;
};

void build(const BuildArguments& args) {
  if (args.poses.empty()) {
    throw CommandFailed{
        1,
        "map build needs --poses TRAJECTORY.tum: building a map without known poses "
        "is not available yet"};
  }
  const auto poses = value_or_fail(io::read_tum(args.poses));
  map::MapSource source;
  for (const std::string& log : args.logs) {
    const pipeline::Config config = value_or_fail(args.run.load(log));
    io::LogOptions options = value_or_fail(args.run.log_options(), 2);
    options.need_imu = false;
    auto reader = value_or_fail(io::open_log(log, options));
    ProgressBar bar("reading " + std::filesystem::path(log).filename().string());
    const auto added =
        value_or_fail(pipeline::accumulate(*reader, poses, config.T_body_lidar, config.preprocess,
                                           source.cloud, [&](double share) { bar.update(share); }));
    if (added.scans == 0) {
      throw CommandFailed{1, fmt::format("{}: none of its {} scans lies inside the times of {}",
                                         log, added.scans + added.outside, args.poses)};
    }
    source.name +=
        (source.name.empty() ? "" : " + ") + std::filesystem::path(log).filename().string();
  }
  make_map(std::move(source), args.out, std::max(args.run.threads, 1));
}

void add_build(CLI::App& map) {
  auto* command = map.add_subcommand("build", "make a map from logs with known poses");
  auto args = std::make_shared<BuildArguments>();
  command->add_option("logs", args->logs, "logs (.bag or KITTI raw folder)")->required();
  command->add_option("--poses", args->poses, "T_map_body over the time of the logs (TUM)");
  command->add_option("--out", args->out, "folder of the map")->required();
  args->run.add_to(*command);
  command->callback([args] { build(*args); });
}

void add_info(CLI::App& map) {
  auto* command = map.add_subcommand("info", "what a map holds; checks every file of it");
  auto path = std::make_shared<std::string>();
  command->add_option("map", *path, "folder of the map")->required();
  command->callback([path] {
    const auto info = value_or_fail(map::read_map_info(*path));
    value_or_fail(map::PriorMap::verify(*path, info));
    print_info(info, *path);
    print_places(*path);
  });
}

void add_export(CLI::App& map) {
  auto* command = map.add_subcommand("export", "write the points of a map as a cloud");
  auto args = std::make_shared<std::array<std::string, 2>>();
  command->add_option("map", (*args)[0], "folder of the map")->required();
  command->add_option("--out", (*args)[1], "cloud to write (.pcd or .ply)")->required();
  command->callback([args] {
    const auto info = value_or_fail(map::read_map_info((*args)[0]));
    const auto cloud = value_or_fail(map::PriorMap::read_points((*args)[0], info));
    value_or_fail(io::write_cloud((*args)[1], cloud));
    fmt::print("{} points written to {}\n", cloud.points.size(), (*args)[1]);
  });
}

}  // namespace

void add_map_command(CLI::App& app) {
  auto* map = app.add_subcommand("map", "make, inspect and export prior maps");
  map->require_subcommand(1);
  add_import(*map);
  add_build(*map);
  add_info(*map);
  add_export(*map);
}

}  // namespace holdfast::apps
