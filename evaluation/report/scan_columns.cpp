#include "evaluation/report/scan_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

Json rounded(double value, int decimals) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

using ScanFigure = std::function<double(const ScanRecord&)>;

/// Adds the list of one figure, unless it is known for no scan.
void add_column(const char* name, int decimals, const std::vector<ScanRecord>& scans,
                const ScanFigure& figure, Json& out) {
  Json values = Json::array();
  bool any = false;
  for (const ScanRecord& scan : scans) {
    values.push_back(rounded(figure(scan), decimals));
    any = any || !values.back().is_null();
  }
  if (any) out[name] = std::move(values);
}

/// Texts as places in a list of the different ones.
void add_words(const char* name, const char* list_name, const std::vector<std::string>& words,
               Json& out) {
  std::vector<std::string> known;
  Json places = Json::array();
  for (const std::string& word : words) {
    auto found = std::find(known.begin(), known.end(), word);
    if (found == known.end()) found = known.insert(known.end(), word);
    places.push_back(found - known.begin());
  }
  out[name] = std::move(places);
  out[list_name] = known;
}

ScanFigure position(Eigen::Index axis) {
  return [axis](const ScanRecord& scan) {
    return scan.claimed ? scan.T_map_body.translation[axis] : kNotKnown;
  };
}

/// Yaw, pitch and roll (0, 1, 2) in degrees: R = Rz(yaw) Ry(pitch) Rx(roll).
ScanFigure angle(int which) {
  return [which](const ScanRecord& scan) {
    if (!scan.claimed) return kNotKnown;
    const Eigen::Matrix3d R = scan.T_map_body.rotation.toRotationMatrix();
    if (which == 0) return kDegrees * std::atan2(R(1, 0), R(0, 0));
    if (which == 1) return kDegrees * std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
    return kDegrees * std::atan2(R(2, 1), R(2, 2));
  };
}

void add_poses(const std::vector<ScanRecord>& scans, Json& out) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  constexpr std::array<const char*, 3> kAngles = {"yaw", "pitch", "roll"};
  for (int i = 0; i < 3; ++i) add_column(kAxes[i], 4, scans, position(i), out);
  for (int i = 0; i < 3; ++i) add_column(kAngles[i], 2, scans, angle(i), out);
  add_column(
      "error_m", 6, scans, [](const ScanRecord& s) { return s.trans_error_m; }, out);
  add_column(
      "error_deg", 4, scans, [](const ScanRecord& s) { return s.rot_error_deg; }, out);
}

void add_step_figures(const ReportInput& input, Json& out) {
  const std::vector<StepRow>& rows = input.steps.rows;
  const auto of_row = [&rows](const std::function<double(const StepRow&)>& figure) -> ScanFigure {
    return [&rows, figure](const ScanRecord& scan) {
      return scan.row < 0 ? kNotKnown : figure(rows[static_cast<std::size_t>(scan.row)]);
    };
  };
  const auto add = [&](const char* name, int decimals, double StepRow::*member, double factor) {
    const auto figure = [member, factor](const StepRow& row) { return factor * row.*member; };
    add_column(name, decimals, input.scans, of_row(figure), out);
  };
  add("p_wrong", 5, &StepRow::p_wrong, 1);
  add("matches", 0, &StepRow::matches, 1);
  add("inlier_share", 4, &StepRow::inlier_share, 1);
  add("residual_m", 5, &StepRow::mean_abs_residual_m, 1);
  add("sigma_m", 6, &StepRow::sigma_trans_m, 1);
  add("sigma_deg", 5, &StepRow::sigma_rot_rad, kDegrees);
  add("ms_total", 3, &StepRow::ms_total, 1);
  Json stages = Json::object();
  for (std::size_t i = 0; i < input.steps.stages.size(); ++i)
    add_column(input.steps.stages[i].c_str(), 3, input.scans,
               of_row([i](const StepRow& row) { return row.ms_stages[i]; }), stages);
  out["stages"] = std::move(stages);
}

}  // namespace

Json scan_columns_json(const ReportInput& input, TimeNs begin) {
  Json out;
  std::vector<std::string> statuses;
  std::vector<std::string> reasons;
  for (const ScanRecord& scan : input.scans) {
    statuses.push_back(scan.status.empty() ? "NO CLAIM" : scan.status);
    reasons.push_back(scan.row < 0 ? std::string()
                                   : input.steps.rows[static_cast<std::size_t>(scan.row)].reason);
  }
  add_column(
      "t", 4, input.scans, [begin](const ScanRecord& scan) { return to_seconds(scan.t - begin); },
      out);
  add_words("status", "statuses", statuses, out);
  add_words("reason", "reasons", reasons, out);
  add_poses(input.scans, out);
  add_step_figures(input, out);
  return out;
}

Json truth_path_json(const Trajectory& truth) {
  if (truth.empty()) return nullptr;
  constexpr TimeNs kPeriod = kSecond * 9 / 100;
  const TruthTrack track(truth);
  Json x = Json::array();
  Json y = Json::array();
  TimeNs next = truth.front().t;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool broken = i > 0 && track.broken_before(i);
    if (broken) {
      x.push_back(nullptr);
      y.push_back(nullptr);
    }
    if (!broken && truth[i].t < next) continue;
    x.push_back(rounded(truth[i].T_map_body.translation.x(), 3));
    y.push_back(rounded(truth[i].T_map_body.translation.y(), 3));
    next = truth[i].t + kPeriod;
  }
  return {{"x", std::move(x)}, {"y", std::move(y)}};
}

}  // namespace holdfast::evaluation
