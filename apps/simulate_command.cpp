#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/commands.hpp"
#include "apps/progress_bar.hpp"
#include "simulation/aliases/alias_output.hpp"
#include "simulation/faults.hpp"
#include "simulation/files/simulator_reference.hpp"
#include "simulation/log_output.hpp"
#include "simulation/sensors/imu/imu_file.hpp"
#include "simulation/sensors/lidar/lidar_file.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::apps {
namespace {

struct SimulateArguments {
  std::string scenario;
  std::string out;
  std::uint64_t seed = 1;
  std::optional<double> duration_s;
  std::vector<std::string> events;
  double changed_percent = 0;
  simulation::Motion motion = simulation::Motion::kWheels;
  double speed_factor = 1;
  double wobble_deg = 0;
  std::string lidar = "rs16";
  std::string imu = "article";
  bool wheel = false;
  bool gnss = false;
  std::optional<double> range_noise_m;
  std::optional<double> map_noise_m;
  std::string faults;
  simulation::Weather weather;
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  bool list = false;
  bool reference = false;
  bool aliases = false;
  bool aliases_each_scan = false;
};

void print_scenarios() {
  for (const auto& info : simulation::scenarios()) {
    std::printf("%-10.*s  %.*s\n", static_cast<int>(info.name.size()), info.name.data(),
                static_cast<int>(info.summary.size()), info.summary.data());
  }
}

std::vector<simulation::EventSpec> parse_events(const std::vector<std::string>& texts) {
  std::vector<simulation::EventSpec> events;
  for (const std::string& text : texts) {
    const auto event = simulation::parse_event(text);
    if (!event) throw CommandFailed{2, event.error().message};
    events.push_back(*event);
  }
  return events;
}

void write_with_progress(simulation::Simulation& simulation, const std::string& folder) {
  ProgressBar bar("simulate");
  const auto progress = [&](double share, std::string_view doing) {
    bar.update(share, std::string(doing));
  };
  const Status written = simulation::write_log(simulation, folder, progress);
  if (!written) throw CommandFailed{1, written.error().message};
}

void print_changes(const simulation::Simulation& simulation) {
  const auto& changes = simulation.changes();
  if (changes.empty()) return;
  const auto count = [&](simulation::ChangeKind kind) {
    return std::count_if(changes.begin(), changes.end(),
                         [kind](const auto& change) { return change.kind == kind; });
  };
  std::printf("%zu of %zu objects changed since the survey: %td moved, %td gone, %td new\n",
              changes.size(), simulation.scenario().world.objects.size(),
              count(simulation::ChangeKind::kMoved), count(simulation::ChangeKind::kRemoved),
              count(simulation::ChangeKind::kAdded));
}

void print_remark(const simulation::Scenario& scenario) {
  if (!scenario.remark.empty()) std::printf("%s\n", scenario.remark.c_str());
}

/// After the log: where in it other places look the same.
void add_aliases(const simulation::Simulation& simulation, const SimulateArguments& arguments) {
  simulation::AliasModel model;
  if (arguments.aliases_each_scan) model.every_m = 0;
  const auto found = simulation::write_aliases(simulation, model, arguments.out);
  if (!found) throw CommandFailed{1, found.error().message};
  std::printf("aliases.jsonl: %.1f s look like other places, in %zu stretches\n", found->aliased_s,
              found->stretches);
}

simulation::SimulationOptions options_of(const SimulateArguments& arguments) {
  simulation::SimulationOptions options;
  options.scenario = arguments.scenario;
  options.seed = arguments.seed;
  options.duration_s = arguments.duration_s;
  options.events = parse_events(arguments.events);
  options.changed_share = arguments.changed_percent / 100;
  options.motion = arguments.motion;
  options.speed_factor = arguments.speed_factor;
  options.wobble_rad = arguments.wobble_deg * std::numbers::pi / 180;
  const auto lidar = simulation::make_lidar(arguments.lidar);
  if (!lidar) throw CommandFailed{2, "simulate: " + lidar.error().message};
  options.lidar = *lidar;
  const auto imu = simulation::make_imu(arguments.imu);
  if (!imu) throw CommandFailed{2, "simulate: " + imu.error().message};
  options.imu = *imu;
  if (arguments.wheel) options.wheel.emplace();
  if (arguments.gnss) options.gnss.emplace();
  options.lidar.range_sigma_m = arguments.range_noise_m.value_or(options.lidar.range_sigma_m);
  options.map_sigma_m = arguments.map_noise_m.value_or(options.map_sigma_m);
  options.weather = arguments.weather;
  if (!arguments.faults.empty()) {
    const Status applied = simulation::apply_faults(arguments.faults, options);
    if (!applied) throw CommandFailed{2, "simulate: " + applied.error().message};
  }
  options.threads = arguments.threads > 0 ? arguments.threads : 1;
  return options;
}

void simulate(const SimulateArguments& arguments) {
  if (arguments.list) return print_scenarios();
  if (arguments.reference) {
    std::printf("%s", simulation::simulator_reference().c_str());
    return;
  }
  if (arguments.scenario.empty()) {
    throw CommandFailed{
        2,
        "simulate: expected a SCENARIO (--list shows them) or a file that ends in .yaml, "
        ".pcd, .ply or .obj"};
  }
  if (arguments.out.empty()) throw CommandFailed{2, "simulate: expected --out DIR"};
  auto simulation = simulation::Simulation::create(options_of(arguments));
  if (!simulation) throw CommandFailed{2, "simulate: " + simulation.error().message};

  write_with_progress(**simulation, arguments.out);
  const std::string pose = simulation::pose_text((*simulation)->initial_pose());
  std::printf("%s: run.bag truth.tum events.jsonl map.pcd config.yaml\n", arguments.out.c_str());
  std::printf("%zu scans, %.1f s\n", (*simulation)->scan_count(),
              to_seconds((*simulation)->end_time() - (*simulation)->start_time()));
  print_changes(**simulation);
  print_remark((*simulation)->scenario());
  if (arguments.aliases || arguments.aliases_each_scan) add_aliases(**simulation, arguments);
  std::printf("the drive begins at --initial-pose \"%s\"\n", pose.c_str());
}

std::string lidar_help() {
  std::string names;
  for (const std::string_view name : simulation::lidar_names()) names += std::string(name) + ", ";
  return names +
         "or a file that ends in .yaml and describes one (--reference says how; default rs16)";
}

std::string imu_help() {
  std::string names;
  for (const std::string_view name : simulation::imu_names()) names += std::string(name) + ", ";
  return names +
         "or a file that ends in .yaml and describes one (--reference says how; default article)";
}

std::string faults_help() {
  std::string help = "comma list of what real sensors do wrong, in usual sizes (default: nothing)";
  for (const simulation::FaultPreset& preset : simulation::fault_presets()) {
    help += "; " + std::string(preset.name) + ": " + std::string(preset.summary);
  }
  return help;
}

/// Further sensors, faults of all of them, and the air that the LiDAR looks through.
void add_sensors(CLI::App& command, SimulateArguments& arguments) {
  command.add_option("--imu", arguments.imu, imu_help())->type_name("NAME");
  command.add_option("--faults", arguments.faults, faults_help())->type_name("NAMES");
  command.add_flag("--wheel", arguments.wheel,
                   "run.bag holds wheel odometry with slip on /wheel_odometry "
                   "(nav_msgs/Odometry, 50 Hz)");
  command.add_flag("--gnss", arguments.gnss,
                   "run.bag holds positions with outages on /gnss (sensor_msgs/NavSatFix, 10 Hz)");
  command
      .add_option("--rain", arguments.weather.rain_mm_h,
                  "rain in millimetres an hour, which the LiDAR sees and looks through; 0 to 200 "
                  "(default 0; 20 is heavy)")
      ->type_name("MM_H");
  command
      .add_option("--visibility", arguments.weather.visibility_m,
                  "in fog or dust, in metres; 5 to 100000 (default: clear air)")
      ->type_name("M");
}

void add_motion(CLI::App& command, SimulateArguments& arguments) {
  using simulation::Motion;
  const std::map<std::string, Motion> words = {{"wheels", Motion::kWheels},
                                               {"handheld", Motion::kHandheld},
                                               {"turn_on_spot", Motion::kTurnOnSpot}};
  command
      .add_option("--motion", arguments.motion,
                  "who moves the LiDAR: wheels (the scenario's robot, default), handheld (a "
                  "walking person: 1 to 3 m/s, steps, turns of up to 3 rad/s about all axes) or "
                  "turn_on_spot (the robot stops at sharp corners and turns there)")
      ->transform(CLI::CheckedTransformer(words))
      ->type_name("WORD");
}

/// Options that make the drive harder than the scenario is.
void add_hardships(CLI::App& command, SimulateArguments& arguments) {
  command
      .add_option("--changed", arguments.changed_percent,
                  "share of the world's movable objects (furniture, loads, cars, boards, signs) "
                  "that was moved, removed or added after the survey: map.pcd shows the world "
                  "before, run.bag the world after; 0 to 100 (default 0)")
      ->transform([](std::string text) {
        if (text.ends_with('%')) text.pop_back();
        return text;
      })
      ->type_name("PERCENT");
  add_motion(command, arguments);
  command
      .add_option("--speed", arguments.speed_factor,
                  "drive the same way so many times as fast, turns and accelerations as well; "
                  "0.1 to 10 (default 1)")
      ->type_name("FACTOR");
  command
      .add_option("--wobble", arguments.wobble_deg,
                  "amplitude in degrees of roll, pitch and yaw oscillations at 1 to 3 Hz while the "
                  "robot moves, as of a LiDAR in the hand (5) or on a rough road (2); 0 to 30 "
                  "(default 0)")
      ->type_name("DEG");
  command.add_option("--lidar", arguments.lidar, lidar_help())->type_name("NAME");
  command
      .add_option(
          "--range-noise", arguments.range_noise_m,
          "standard deviation of the LiDAR's ranges in metres (default: the LiDAR's); config.yaml "
          "says it as lidar.range_sigma_m")
      ->type_name("M");
  command
      .add_option("--map-noise", arguments.map_noise_m,
                  "standard deviation of the points of map.pcd on each axis in metres (default "
                  "0.005)")
      ->type_name("M");
}

void add_alias_flags(CLI::App& command, SimulateArguments& arguments) {
  command.add_flag("--aliases", arguments.aliases,
                   "also write aliases.jsonl: for each metre of the drive the other places where a "
                   "scan would look the same within noise, one line a stretch");
  command.add_flag("--aliases-each-scan", arguments.aliases_each_scan, "the same for each scan");
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "simulate", "Drive a simulated robot through a world and write what its sensors saw");
  auto arguments = std::make_shared<SimulateArguments>();
  command->add_option(
      "SCENARIO", arguments->scenario,
      "world to drive through (--list shows them), or a file that ends in .yaml and "
      "describes one (--reference says how), or a cloud or mesh that is one (.pcd, .ply, .obj), "
      "through which a way is then looked for");
  command
      ->add_option("--out", arguments->out,
                   "folder for run.bag, truth.tum, events.jsonl, map.pcd and config.yaml")
      ->type_name("DIR");
  command->add_option("--seed", arguments->seed, "another drive with other noise (default 1)")
      ->type_name("N");
  command
      ->add_option("--duration", arguments->duration_s,
                   "seconds to drive (default: the scenario's whole route)")
      ->type_name("S");
  command
      ->add_option(
          "--event", arguments->events,
          "NAME@T0[+DURATION], seconds from the start: blind (empty clouds), lidar_off and "
          "imu_off (no messages), each 2 s long by default; imu_bias_jump; crowd (10 s); kidnap "
          "(at once, or carried with the LiDAR covered for DURATION); clock_jump (of the LiDAR's "
          "stamps, for good unless it has a duration); may be given more than once")
      ->type_name("EVENT")
      ->allow_extra_args(false);
  add_hardships(*command, *arguments);
  add_sensors(*command, *arguments);
  command
      ->add_option("--threads", arguments->threads,
                   "threads for casting rays (default: all cores); the output does not depend "
                   "on it")
      ->type_name("N");
  add_alias_flags(*command, *arguments);
  command->add_flag("--list", arguments->list, "show the scenarios and stop");
  command->add_flag("--reference", arguments->reference,
                    "show how to write a scenario file, and stop");
  command->footer(
      "Example:\n  holdfast simulate corridor --out /tmp/drive --seed 3 "
      "--event kidnap@30 --event blind@50+3\n");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace holdfast::apps
