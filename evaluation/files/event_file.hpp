#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/time.hpp"

namespace holdfast::evaluation {

/// One line of an events.jsonl: what was done to the robot (simulated: "t0", "t1", "event") or what
/// the system did (a run's: "t", "event", "from", "to", "reason", ...).
struct Event {
  std::string name;  ///< "kidnap", "blind", ..., or "status", "alarm", "relocalized", ...
  TimeNs t0 = 0;
  TimeNs t1 = 0;  ///< equal to t0 for an event without duration
  /// All further keys as text, in the order of the file.
  std::vector<std::pair<std::string, std::string>> details;
};

struct EventList {
  std::vector<Event> events;  ///< in order of t0
  bool truncated = false;     ///< the last line was cut off and is left out
};

/// Times are seconds on the log's clock. Errors name file and line; a broken last line without an
/// end is dropped (the run was killed).
Result<EventList> read_events(const std::filesystem::path& path);

}  // namespace holdfast::evaluation
