#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/report/report.hpp"

namespace holdfast::evaluation {

/// What happened to the robot and what the run did, in order of time, as the page shows it: time
/// from `begin` (s), name, source ("world" or "run"), a text in one line, for alarms and searches
/// `lines` of what spoke for and against, and for searches the `candidates` as x, y (m), yaw
/// (degrees) and probability.
nlohmann::ordered_json event_list_json(const ReportInput& input, TimeNs begin);

}  // namespace holdfast::evaluation
