#include "evaluation/result/result_keys.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "evaluation/result/number_text.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using Unit = ResultKey::Unit;
using E = const Evaluation&;

double number(std::size_t n) { return static_cast<double>(n); }

constexpr auto kKeys = std::to_array<ResultKey>({
    {"ate_rmse_m", "position error, RMSE", "root mean square distance to the truth, all claims",
     Unit::kLength, [](E e) { return e.trans_m.rmse; }},
    {"ate_mean_m", "position error, mean", "mean distance to the truth", Unit::kLength,
     [](E e) { return e.trans_m.mean; }},
    {"ate_median_m", "position error, median", "median distance to the truth", Unit::kLength,
     [](E e) { return e.trans_m.median; }},
    {"ate_p95_m", "position error, 95 %", "95 of 100 claims are closer to the truth", Unit::kLength,
     [](E e) { return e.trans_m.p95; }},
    {"ate_max_m", "position error, worst", "largest distance to the truth", Unit::kLength,
     [](E e) { return e.trans_m.max; }},
    {"rot_rmse_deg", "rotation error, RMSE", "root mean square angle to the truth", Unit::kAngle,
     [](E e) { return e.rot_deg.rmse; }},
    {"rot_median_deg", "rotation error, median", "median angle to the truth", Unit::kAngle,
     [](E e) { return e.rot_deg.median; }},
    {"rot_p95_deg", "rotation error, 95 %", "95 of 100 claims are closer to the truth",
     Unit::kAngle, [](E e) { return e.rot_deg.p95; }},
    {"rot_max_deg", "rotation error, worst", "largest angle to the truth", Unit::kAngle,
     [](E e) { return e.rot_deg.max; }},
    {"coverage", "coverage", "share of scans after the first 2 s that have a claim", Unit::kShare,
     [](E e) { return e.coverage.value(); }},
    {"success", "success",
     "share of scans with a claim within 0.3 m and 5 deg; no claim is failure", Unit::kShare,
     [](E e) { return e.success.value(); }},
    {"misleading", "misleading",
     "share of scans claimed in TRACKING, or in DEGRADED in a direction not declared, "
     "while over 0.5 m or 5 deg wrong",
     Unit::kShare, [](E e) { return e.misleading.value(); }},
    {"misleading_scans", "misleading scans", "the same as a number", Unit::kCount,
     [](E e) { return number(e.misleading.count); }},
    {"trusted", "trusted", "share of scans claimed in TRACKING or DEGRADED", Unit::kShare,
     [](E e) { return e.trusted.value(); }},
    {"e2e_m", "error at the end", "distance to the truth at the last scan; null without a claim",
     Unit::kLength, [](E e) { return e.e2e_m.value_or(kNotKnown); }},
    {"e2e_deg", "rotation error at the end", "angle to the truth at the last scan", Unit::kAngle,
     [](E e) { return e.e2e_deg.value_or(kNotKnown); }},
    {"rpe_10m", "drift over 10 m", "RMSE of the relative position over 10 m of way, in m",
     Unit::kLength, [](E e) { return e.drift[0].trans_rmse_m; }},
    {"rpe_20m", "drift over 20 m", "RMSE of the relative position over 20 m of way, in m",
     Unit::kLength, [](E e) { return e.drift[1].trans_rmse_m; }},
    {"rpe_50m", "drift over 50 m", "RMSE of the relative position over 50 m of way, in m",
     Unit::kLength, [](E e) { return e.drift[2].trans_rmse_m; }},
    {"rpe_10m_deg", "turn over 10 m", "RMSE of the relative rotation over 10 m of way",
     Unit::kAngle, [](E e) { return e.drift[0].rot_rmse_deg; }},
    {"rpe_20m_deg", "turn over 20 m", "RMSE of the relative rotation over 20 m of way",
     Unit::kAngle, [](E e) { return e.drift[1].rot_rmse_deg; }},
    {"rpe_50m_deg", "turn over 50 m", "RMSE of the relative rotation over 50 m of way",
     Unit::kAngle, [](E e) { return e.drift[2].rot_rmse_deg; }},
    {"drift_10m_percent", "drift over 10 m, share", "mean relative position error in % of the way",
     Unit::kPercent, [](E e) { return e.drift[0].drift_percent; }},
    {"drift_20m_percent", "drift over 20 m, share", "mean relative position error in % of the way",
     Unit::kPercent, [](E e) { return e.drift[1].drift_percent; }},
    {"drift_50m_percent", "drift over 50 m, share", "mean relative position error in % of the way",
     Unit::kPercent, [](E e) { return e.drift[2].drift_percent; }},
    {"scans", "scans", "scans that were due, the first 2 s included", Unit::kCount,
     [](E e) { return number(e.scans); }},
    {"scans_counted", "scans counted", "scans after the first 2 s, over which shares are taken",
     Unit::kCount, [](E e) { return number(e.coverage.of); }},
    {"claimed", "claims", "scans with a pose", Unit::kCount, [](E e) { return number(e.claimed); }},
    {"judged", "claims judged", "claims with a true pose, over which errors are taken",
     Unit::kCount, [](E e) { return number(e.judged); }},
    {"outside_truth", "claims outside the truth", "claims before or after the truth; not judged",
     Unit::kCount, [](E e) { return number(e.outside_truth); }},
    {"in_truth_gap", "claims in gaps of the truth", "claims where the truth has a gap; not judged",
     Unit::kCount, [](E e) { return number(e.in_truth_gap); }},
    {"duration_s", "duration", "first to last scan", Unit::kSeconds,
     [](E e) { return to_seconds(e.end - e.begin); }},
    {"path_m", "way", "true way, teleports left out", Unit::kLength, [](E e) { return e.path_m; }},
    {"false_relocalizations", "false relocalizations",
     "relocalizations accepted while over 0.5 m or 5 deg wrong", Unit::kCount,
     [](E e) { return number(e.false_relocalizations); }},
});

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : Json(nullptr);
}

Json interval_json(const Share& share) {
  const Interval interval = interval_95(share);
  return Json::array({number_or_null(interval.low), number_or_null(interval.high)});
}

Json pose_json(const SE3& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return Json::array({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

Json event_json(const EventScore& score) {
  return {{"event", score.event.name},
          {"t0", to_seconds(score.event.t0)},
          {"t1", to_seconds(score.event.t1)},
          {"moved_m", number_or_null(score.moved_m)},
          {"moved_deg", number_or_null(score.moved_deg)},
          {"noticed_after_s", number_or_null(score.noticed_after_s)},
          {"recovery_s", number_or_null(score.recovery_s)},
          {"worst_claim_m", number_or_null(score.worst_claim_m)},
          {"misleading_scans", score.misleading_scans}};
}

std::string_view unit_name(Unit unit) {
  switch (unit) {
    case Unit::kCount: return "count";
    case Unit::kLength: return "m";
    case Unit::kAngle: return "deg";
    case Unit::kShare: return "0 to 1";
    case Unit::kPercent: return "%";
    case Unit::kSeconds: return "s";
  }
  return "";
}

}  // namespace

std::span<const ResultKey> result_keys() { return kKeys; }

std::string value_text(const ResultKey& key, const Evaluation& evaluation) {
  const double value = key.value(evaluation);
  switch (key.unit) {
    case Unit::kCount: return count_text(value);
    case Unit::kLength: return length_text(value);
    case Unit::kAngle: return angle_text(value);
    case Unit::kShare: return share_text(value);
    case Unit::kPercent: return std::isfinite(value) ? plain_text(value) + " %" : "-";
    case Unit::kSeconds: return seconds_text(value);
  }
  return "-";
}

std::string result_json(const Evaluation& evaluation) {
  Json json;
  for (const ResultKey& key : kKeys) {
    const double value = key.value(evaluation);
    const bool count = key.unit == Unit::kCount;
    json[std::string(key.key)] =
        count ? Json(static_cast<std::int64_t>(value)) : number_or_null(value);
  }
  json["coverage_ci95"] = interval_json(evaluation.coverage);
  json["success_ci95"] = interval_json(evaluation.success);
  json["misleading_ci95"] = interval_json(evaluation.misleading);
  json["from_steps"] = evaluation.from_steps;
  json["align"] = evaluation.align == Alignment::kRigid ? "se3" : "none";
  json["T_truth_estimate"] = pose_json(evaluation.T_truth_estimate);
  json["events"] = Json::array();
  for (const EventScore& score : evaluation.events) json["events"].push_back(event_json(score));
  json["relocalizations"] = Json::array();
  for (const RelocalizationScore& score : evaluation.relocalizations)
    json["relocalizations"].push_back({{"t", to_seconds(score.t)},
                                       {"error_m", number_or_null(score.trans_error_m)},
                                       {"error_deg", number_or_null(score.rot_error_deg)}});
  json["warnings"] = evaluation.warnings;
  return json.dump(2) + "\n";
}

std::string result_key_reference() {
  std::string text;
  for (const ResultKey& key : kKeys)
    text += fmt::format("{:<22} {:<7} {}\n", key.key, unit_name(key.unit), key.meaning);
  return text;
}

}  // namespace holdfast::evaluation
