#include "simulation/log_output.hpp"

#include <fmt/format.h>

#include <sstream>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/config_io.hpp"
#include "holdfast/io/tum_file.hpp"

namespace holdfast::simulation {
namespace {

// Of the whole run, about this share goes into scans and IMU samples.
constexpr double kStreamShare = 0.9;

Status write_bag(Simulation& simulation, const std::filesystem::path& path,
                 const Progress& progress) {
  auto writer = io::BagWriter::create(path, {});
  if (!writer) return writer.error();
  while (true) {
    auto event = simulation.next();
    if (!event) return event.error();
    if (!event->has_value()) break;
    const auto write = [&](const auto& message) { return (*writer)->write(message); };
    Status written = std::visit(write, **event);
    if (!written) return written;
    if (std::holds_alternative<Scan>(**event)) {
      progress(kStreamShare * simulation.progress(), "driving");
    }
  }
  return (*writer)->close();
}

std::string events_text(const Simulation& simulation) {
  std::string text;
  for (const SimulatedEvent& event : simulation.events()) text += event_json(event) + "\n";
  return text;
}

/// What the drive has that the keys of a configuration do not say, as comments.
std::string hardships_text(const SimulationOptions& options) {
  std::string text;
  LidarFaults faults = options.lidar.faults;
  if (!faults.none()) {
    std::vector<io::FieldRef> fields;
    io::collect_fields("", faults, fields);
    text += "# lidar faults, beside lidar.range_sigma_m:\n";
    std::istringstream lines(io::write_config(fields));
    for (std::string line; std::getline(lines, line);) text += "#   " + line + "\n";
  }
  if (!options.weather.is_clear()) {
    text += fmt::format("# weather: rain {} mm/h, visibility {} m (0: clear)\n",
                        options.weather.rain_mm_h, options.weather.visibility_m);
  }
  return text;
}

}  // namespace

std::string pose_text(const SE3& pose) {
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format("{:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}", p.x(), p.y(), p.z(), q.x(),
                     q.y(), q.z(), q.w());
}

std::string robot_config(Simulation& simulation) {
  const ImuModel& imu = simulation.options().imu;
  const LidarModel& lidar = simulation.options().lidar;
  const auto& p = lidar.T_body_lidar.translation;
  const auto& q = lidar.T_body_lidar.rotation;
  return fmt::format(
      "# simulated: scenario {}, seed {}\n"
      "# initial_pose: {}\n"
      "{}"
      "T_body_lidar: [{}, {}, {}, {}, {}, {}, {}]\n"
      "imu:\n"
      "  gyro_noise_density: {}\n"
      "  accel_noise_density: {}\n"
      "  gyro_bias_walk: {}\n"
      "  accel_bias_walk: {}\n"
      "lidar:\n"
      "  range_sigma_m: {}\n",
      simulation.scenario().name, simulation.options().seed, pose_text(simulation.initial_pose()),
      hardships_text(simulation.options()), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
      imu.gyro_noise_density, imu.accel_noise_density, imu.gyro_bias_walk, imu.accel_bias_walk,
      lidar.range_sigma_m);
}

Status write_log(Simulation& simulation, const std::filesystem::path& folder,
                 const Progress& progress) {
  auto output = io::AtomicFolder::create(folder, "truth.tum");
  if (!output) return output.error();
  const auto path = [&](const char* name) { return output->staging() / name; };
  if (auto done = io::write_file_atomically(path("config.yaml"), robot_config(simulation)); !done) {
    return done;
  }
  if (auto done = write_bag(simulation, path("run.bag"), progress); !done) return done;
  if (auto done = io::write_tum(path("truth.tum"), simulation.truth()); !done) return done;
  if (auto done = io::write_file_atomically(path("events.jsonl"), events_text(simulation)); !done) {
    return done;
  }
  progress(kStreamShare, "surveying the map");
  if (auto done = io::write_cloud(path("map.pcd"), simulation.survey_map()); !done) return done;
  progress(1.0, "done");
  return output->commit();
}

}  // namespace holdfast::simulation
