#include "benchmarks/drives/surveyed_drive.hpp"

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "holdfast/places/place_maker.hpp"
#include "simulation/log_output.hpp"

namespace holdfast::benchmarks {

Result<std::unique_ptr<simulation::Simulation>> make_drive(const DriveSpec& spec) {
  simulation::SimulationOptions options;
  options.scenario = spec.scenario;
  options.seed = spec.seed;
  options.duration_s = spec.duration_s;
  options.threads = spec.threads;
  options.lidar = spec.lidar;
  options.events = spec.events;
  options.changed_share = spec.changed_share;
  options.motion = spec.motion;
  return simulation::Simulation::create(options);
}

Result<pipeline::Config> load_robot_config(simulation::Simulation& drive,
                                           const std::vector<std::string>& settings,
                                           const std::filesystem::path& dir) {
  const auto file = dir / "config.yaml";
  const std::string text = simulation::robot_config(drive);
  if (auto written = io::write_file_atomically(file, text); !written) return written.error();
  return pipeline::load_config(file, settings);
}

Result<SurveyedDrive> survey_drive(const DriveSpec& spec, const std::filesystem::path& dir) {
  auto simulation = make_drive(spec);
  if (!simulation) return simulation.error();
  SurveyedDrive drive;
  drive.simulation = std::move(*simulation);
  drive.map_dir = dir / "map";
  auto config = load_robot_config(*drive.simulation, spec.settings, dir);
  if (!config) return config.error();
  drive.config = *config;
  drive.initial_pose = drive.simulation->initial_pose();
  map::MapSource source{drive.simulation->survey_map(), std::nullopt, spec.scenario};
  WorkerPool pool(spec.threads);
  if (auto info = places::build_map(std::move(source), drive.map_dir, pool); !info) {
    return info.error();
  }
  return drive;
}

Status record_bag(simulation::Simulation& drive, const std::filesystem::path& bag) {
  auto writer = io::BagWriter::create(bag, {});
  if (!writer) return writer.error();
  while (true) {
    auto event = drive.next();
    if (!event) return event.error();
    if (!event->has_value()) return (*writer)->close();
    const auto write = [&](const auto& message) { return (*writer)->write(message); };
    if (auto written = std::visit(write, **event); !written) return written;
  }
}

}  // namespace holdfast::benchmarks
