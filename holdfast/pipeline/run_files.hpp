#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "holdfast/core/result.hpp"
#include "holdfast/core/step_report.hpp"
#include "holdfast/io/atomic_output.hpp"

namespace holdfast::pipeline {

/// One line of steps.csv, without the end of line, and its header.
std::string steps_header();
std::string format_step(const StepReport& report);

/// The files of a run, written aside as the run goes on; commit() gives the folder its name.
class RunFiles {
 public:
  static Result<RunFiles> create(const std::filesystem::path& dir);

  /// Appends to trajectory.tum (claims only), steps.csv and, on a change of state, when an alarm
  /// begins (with its evidence) and when a search ends (with its candidates), events.jsonl.
  Status add(const StepReport& report);
  /// A further file of the run.
  Status write(const std::string& name, const std::string& content);
  /// Where the files stand until commit().
  const std::filesystem::path& staging() const { return folder_.staging(); }
  Status close();
  Status commit() { return folder_.commit(); }

 private:
  explicit RunFiles(io::AtomicFolder folder);
  void add_status(const StepReport& report);
  void add_alarm(const StepReport& report);
  void add_search(const StepReport& report);
  void add_event(TimeNs t, const nlohmann::ordered_json& rest);

  io::AtomicFolder folder_;
  std::ofstream trajectory_;
  std::ofstream steps_;
  std::ofstream events_;
  State last_state_ = State::kInitializing;
  bool any_ = false;
  bool alarm_ = false;
};

/// Marks a folder as a run, so that another run may replace it.
inline constexpr std::string_view kRunMarker = "summary.json";

}  // namespace holdfast::pipeline
