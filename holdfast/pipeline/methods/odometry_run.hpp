#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/odometry/odometry.hpp"
#include "holdfast/pipeline/config.hpp"

namespace holdfast::pipeline {

/// The odometry as `config` wants it.
odometry::Odometry::Setup odometry_setup(const Config& config, int threads = 1);

/// Told of each scan, with the share of the log that has been read. An Error ends the run.
using OdometryListener = std::function<Status(const odometry::OdometryReport&, double progress)>;

/// Plays a source of sensor events through an odometry, in the order of end times, as fast as it
/// goes.
Status run(SensorSource& source, odometry::Odometry& odometry, const OdometryListener& on_scan);

/// The files of a run of the odometry alone, written aside as it goes on; commit() gives the folder
/// its name.
class OdometryFiles {
 public:
  static Result<OdometryFiles> create(const std::filesystem::path& dir);

  /// Appends to odometry.tum (a line for each scan from the first with a pose on), steps.csv and,
  /// on a change of state or a break, events.jsonl.
  Status add(const odometry::OdometryReport& report);
  /// A further file of the run.
  Status write(const std::string& name, const std::string& content);
  Status close();
  Status commit() { return folder_.commit(); }

 private:
  explicit OdometryFiles(io::AtomicFolder folder);
  void add_events(const odometry::OdometryReport& report);

  io::AtomicFolder folder_;
  std::ofstream odometry_;
  std::ofstream steps_;
  std::ofstream events_;
  State last_state_ = State::kInitializing;
  bool any_ = false;
};

}  // namespace holdfast::pipeline
