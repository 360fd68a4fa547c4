#include "simulation/log_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <variant>
#include <vector>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/config_io.hpp"
#include "holdfast/io/tum_file.hpp"
#include "simulation/stated_extrinsics.hpp"

namespace holdfast::simulation {
namespace {

// Of the whole run, about this share goes into scans and IMU samples.
constexpr double kStreamShare = 0.9;

/// What wheels and satellites tell, in order of time, on its way into a bag.
class Aiding {
 public:
  explicit Aiding(const Simulation& simulation) {
    for (const WheelSample& sample : simulation.wheel_samples()) add(sample, "/wheel_odometry");
    for (const GnssSample& sample : simulation.gnss_samples()) add(sample, "/gnss");
    std::stable_sort(samples_.begin(), samples_.end(),
                     [](const auto& a, const auto& b) { return time(a) < time(b); });
  }
  const io::BagWriter::Topics& topics() const { return topics_; }

  Status write_until(TimeNs t, io::BagWriter& writer) {
    const auto write = [&](const auto& sample) { return writer.write(sample); };
    for (; at_ < samples_.size() && time(samples_[at_]) <= t; ++at_) {
      if (auto written = std::visit(write, samples_[at_]); !written) return written;
    }
    return Done{};
  }

 private:
  using Sample = std::variant<WheelSample, GnssSample>;

  static TimeNs time(const Sample& sample) {
    return std::visit([](const auto& one) { return one.t; }, sample);
  }
  void add(const WheelSample& sample, const char* topic) {
    topics_.wheel = topic;
    samples_.emplace_back(sample);
  }
  void add(const GnssSample& sample, const char* topic) {
    topics_.gnss = topic;
    samples_.emplace_back(sample);
  }

  io::BagWriter::Topics topics_;  ///< of a kind of which there is a sample
  std::vector<Sample> samples_;
  std::size_t at_ = 0;
};

Status write_event(const SensorEvent& event, TimeNs recorded, io::BagWriter& writer) {
  if (const auto* scan = std::get_if<Scan>(&event)) return writer.write(*scan, recorded);
  return writer.write(std::get<ImuSample>(event));
}

Status write_bag(Simulation& simulation, const std::filesystem::path& path,
                 const Progress& progress) {
  Aiding aiding(simulation);
  auto writer = io::BagWriter::create(path, aiding.topics());
  if (!writer) return writer.error();
  while (true) {
    auto event = simulation.next();
    if (!event) return event.error();
    const TimeNs now = event->has_value() ? simulation.last_event_time() : simulation.end_time();
    if (auto written = aiding.write_until(now, **writer); !written) return written;
    if (!event->has_value()) break;
    if (auto written = write_event(**event, now, **writer); !written) return written;
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

std::string pose_list(const SE3& pose) {
  const auto& p = pose.translation;
  const auto& q = pose.rotation;
  return fmt::format("[{}, {}, {}, {}, {}, {}, {}]", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                     q.w());
}

/// What is hard for the LiDAR and the keys of a configuration do not say.
std::string lidar_remarks(const SimulationOptions& options) {
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

/// What a user could only measure: comments on what the options made wrong or added.
std::string remarks(const Simulation& simulation) {
  const SimulationOptions& options = simulation.options();
  std::string text = lidar_remarks(options);
  const std::string& remark = simulation.scenario().remark;
  if (!remark.empty()) text += fmt::format("# {}\n", remark);
  if (!options.extrinsics_error.is_none()) {
    text += "# true_T_body_lidar: " + pose_list(options.lidar.T_body_lidar) + "\n";
  }
  if (!options.transport.lidar_clock.is_true()) {
    const LidarClock& clock = simulation.lidar_clock();
    text += fmt::format("# lidar_clock: ahead by {:.9f} s at the start, gains {:.6f} ppm\n",
                        clock.offset_s(), clock.drift_ppm());
  }
  if (options.gnss) {
    const GeodeticPosition& origin = options.gnss->datum.origin;
    const Eigen::Vector3d& p = options.gnss->p_body_antenna;
    text += fmt::format(
        "# gnss: map origin at latitude {}, longitude {}, altitude {} m; x east, y north\n"
        "# p_body_antenna: [{}, {}, {}]\n",
        origin.latitude_deg, origin.longitude_deg, origin.altitude_m, p.x(), p.y(), p.z());
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
  const SE3 stated = stated_extrinsics(lidar.T_body_lidar, simulation.options().extrinsics_error,
                                       simulation.options().seed);
  return fmt::format(
      "# simulated: scenario {}, seed {}\n"
      "# initial_pose: {}\n"
      "{}"
      "T_body_lidar: {}\n"
      "imu:\n"
      "  gyro_noise_density: {}\n"
      "  accel_noise_density: {}\n"
      "  gyro_bias_walk: {}\n"
      "  accel_bias_walk: {}\n"
      "lidar:\n"
      "  range_sigma_m: {}\n",
      simulation.scenario().name, simulation.options().seed, pose_text(simulation.initial_pose()),
      remarks(simulation), pose_list(stated), imu.gyro_noise_density, imu.accel_noise_density,
      imu.gyro_bias_walk, imu.accel_bias_walk, lidar.range_sigma_m);
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
