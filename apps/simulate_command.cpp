#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/commands.hpp"
#include "apps/progress_bar.hpp"
#include "simulation/log_output.hpp"
#include "simulation/simulation.hpp"

namespace holdfast::apps {
namespace {

struct SimulateArguments {
  std::string scenario;
  std::string out;
  std::uint64_t seed = 1;
  std::optional<double> duration_s;
  std::vector<std::string> events;
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  bool list = false;
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

void simulate(const SimulateArguments& arguments) {
  if (arguments.list) return print_scenarios();
  if (arguments.scenario.empty()) {
    throw CommandFailed{2, "simulate: expected a SCENARIO (--list shows them)"};
  }
  if (arguments.out.empty()) throw CommandFailed{2, "simulate: expected --out DIR"};
  simulation::SimulationOptions options;
  options.scenario = arguments.scenario;
  options.seed = arguments.seed;
  options.duration_s = arguments.duration_s;
  options.events = parse_events(arguments.events);
  options.threads = arguments.threads > 0 ? arguments.threads : 1;
  auto simulation = simulation::Simulation::create(options);
  if (!simulation) throw CommandFailed{2, "simulate: " + simulation.error().message};

  write_with_progress(**simulation, arguments.out);
  const std::string pose = simulation::pose_text((*simulation)->initial_pose());
  std::printf("%s: run.bag truth.tum events.jsonl map.pcd config.yaml\n", arguments.out.c_str());
  std::printf("%zu scans, %.1f s\n", (*simulation)->scan_count(),
              to_seconds((*simulation)->end_time() - (*simulation)->start_time()));
  std::printf("the drive begins at --initial-pose \"%s\"\n", pose.c_str());
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "simulate", "Drive a simulated robot through a world and write what its sensors saw");
  auto arguments = std::make_shared<SimulateArguments>();
  command->add_option("SCENARIO", arguments->scenario,
                      "world to drive through (--list shows them)");
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
      ->add_option("--event", arguments->events,
                   "NAME@T0[+DURATION], seconds from the start: blind (2 s by default), "
                   "imu_bias_jump, kidnap; may be given more than once")
      ->type_name("EVENT")
      ->allow_extra_args(false);
  command
      ->add_option("--threads", arguments->threads,
                   "threads for casting rays (default: all cores); the output does not depend "
                   "on it")
      ->type_name("N");
  command->add_flag("--list", arguments->list, "show the scenarios and stop");
  command->footer(
      "Example:\n  holdfast simulate corridor --out /tmp/drive --seed 3 "
      "--event kidnap@30 --event blind@50+3\n");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace holdfast::apps
