#include "holdfast/pipeline/methods/odometry_run.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "holdfast/io/tum_file.hpp"
#include "holdfast/pipeline/event_sequencer.hpp"
#include "holdfast/pipeline/run_files.hpp"

namespace holdfast::pipeline {
namespace {

Status drain(EventSequencer& sequencer, SensorSource& source, odometry::Odometry& odometry,
             const OdometryListener& on_scan) {
  SensorEvent event;
  while (sequencer.pop(event)) {
    if (const auto* imu = std::get_if<ImuSample>(&event)) {
      odometry.add_imu(*imu);
      continue;
    }
    const auto report = odometry.add_scan(std::get<Scan>(event));
    if (auto heard = on_scan(report, source.progress()); !heard) return heard;
  }
  return Done{};
}

/// A line of events.jsonl; the time with all its digits, which a double would not keep.
std::string event_line(TimeNs t, const nlohmann::ordered_json& rest) {
  return fmt::format("{{\"t\":{},{}\n", format_seconds(t), rest.dump().substr(1));
}

}  // namespace

odometry::Odometry::Setup odometry_setup(const Config& config, int threads) {
  odometry::Odometry::Setup setup;
  setup.odometry = config.odometry;
  setup.map = config.local_map;
  setup.imu = config.imu;
  setup.selection = config.preprocess;
  setup.range_sigma_m = config.lidar.range_sigma_m;
  setup.fastest_m_s = config.start.speed_m_s;
  setup.T_body_lidar = config.T_body_lidar;
  setup.threads = threads;
  return setup;
}

Status run(SensorSource& source, odometry::Odometry& odometry, const OdometryListener& on_scan) {
  EventSequencer sequencer;
  while (true) {
    auto event = source.next();
    if (!event) return event.error();
    const bool ended = !event->has_value();
    if (ended) {
      sequencer.finish();
    } else {
      sequencer.push(std::move(**event));
    }
    if (auto done = drain(sequencer, source, odometry, on_scan); !done) return done;
    if (ended) return Done{};
  }
}

Result<OdometryFiles> OdometryFiles::create(const std::filesystem::path& dir) {
  auto folder = io::AtomicFolder::create(dir, kRunMarker);
  if (!folder) return folder.error();
  OdometryFiles files(std::move(*folder));
  if (!files.odometry_ || !files.steps_ || !files.events_) {
    return Error{fmt::format("{}: cannot write into this folder", dir.string())};
  }
  return files;
}

OdometryFiles::OdometryFiles(io::AtomicFolder folder)
    : folder_(std::move(folder)),
      odometry_(folder_.staging() / "odometry.tum"),
      steps_(folder_.staging() / "steps.csv"),
      events_(folder_.staging() / "events.jsonl") {
  steps_ << steps_header() << '\n';
}

Status OdometryFiles::add(const odometry::OdometryReport& report) {
  const StepReport& step = report.step;
  if (claims_pose(step.state)) {
    odometry_ << io::format_tum_line({step.pose_time, step.T_map_body}) << '\n';
  }
  steps_ << format_step(step) << '\n';
  add_events(report);
  if (!odometry_ || !steps_ || !events_) {
    return Error{fmt::format("{}: cannot write: is the disk full?", folder_.staging().string())};
  }
  return Done{};
}

void OdometryFiles::add_events(const odometry::OdometryReport& report) {
  const StepReport& step = report.step;
  if (report.broke) {
    events_ << event_line(step.pose_time, {{"event", "odom_break"},
                                           {"from", step.odom_epoch - 1},
                                           {"to", step.odom_epoch},
                                           {"reason", step.reason}});
  }
  if (!any_ || step.state != last_state_) {
    events_ << event_line(step.pose_time,
                          {{"event", "status"},
                           {"from", any_ ? std::string(to_string(last_state_)) : ""},
                           {"to", std::string(to_string(step.state))},
                           {"reason", step.reason}});
  }
  any_ = true;
  last_state_ = step.state;
}

Status OdometryFiles::write(const std::string& name, const std::string& content) {
  return io::write_file_atomically(folder_.staging() / name, content);
}

Status OdometryFiles::close() {
  for (auto* file : {&odometry_, &steps_, &events_}) {
    file->close();
    if (file->fail()) return Error{fmt::format("{}: cannot write", folder_.staging().string())};
  }
  return Done{};
}

}  // namespace holdfast::pipeline
