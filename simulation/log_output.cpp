#include "simulation/log_output.hpp"

#include <fmt/format.h>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "holdfast/io/cloud_file.hpp"
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

std::string remark_line(const Scenario& scenario) {
  return scenario.remark.empty() ? "" : fmt::format("# {}\n", scenario.remark);
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
      "{}"
      "# initial_pose: {}\n"
      "T_body_lidar: [{}, {}, {}, {}, {}, {}, {}]\n"
      "imu:\n"
      "  gyro_noise_density: {}\n"
      "  accel_noise_density: {}\n"
      "  gyro_bias_walk: {}\n"
      "  accel_bias_walk: {}\n"
      "lidar:\n"
      "  range_sigma_m: {}\n",
      simulation.scenario().name, simulation.options().seed, remark_line(simulation.scenario()),
      pose_text(simulation.initial_pose()), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
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
