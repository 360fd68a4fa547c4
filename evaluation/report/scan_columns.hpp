#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/report/report.hpp"

namespace holdfast::evaluation {

/// What the page draws over time, one list a figure, all of one length: "t" (seconds since
/// `begin`), "status" and "reason" (places in "statuses" and "reasons"), "x", "y", "z" (m), "yaw",
/// "pitch", "roll" (deg), "error_m", "error_deg", "p_wrong", "matches", "inlier_share",
/// "residual_m", "sigma_m", "sigma_deg", "ms_total" and "stages" {name: list}. Rounded; null where
/// not known; a list without any figure is left out.
nlohmann::ordered_json scan_columns_json(const ReportInput& input, TimeNs begin);

/// The true way from above at about 10 poses a second: {"x", "y"}, with a null at every break.
nlohmann::ordered_json truth_path_json(const Trajectory& truth);

}  // namespace holdfast::evaluation
