#include "evaluation/evaluate.hpp"

#include <fmt/core.h>

#include <numbers>
#include <string_view>
#include <utility>

#include "evaluation/alignment.hpp"
#include "evaluation/time_overlap.hpp"

namespace holdfast::evaluation {
namespace {

ScanList scans_due(const Trajectory& estimate, const TruthTrack& truth, const RunContext& context) {
  if (context.steps.empty()) return scans_from_period(estimate, truth);
  return scans_from_steps(estimate, context.steps, context.is_odometry, truth);
}

void look_up_truth(const TruthTrack& truth, std::vector<ScanRecord>& scans) {
  for (ScanRecord& scan : scans) scan.truth = truth.at(scan.t);
}

SE3 align_claims(std::vector<ScanRecord>& scans) {
  std::vector<SE3> claims;
  std::vector<SE3> truths;
  for (const ScanRecord& scan : scans) {
    if (!scan.has_error()) continue;
    claims.push_back(scan.T_map_body);
    truths.push_back(scan.truth.T_map_body);
  }
  if (claims.empty()) return {};
  SE3 T_truth_estimate = align_rigid(claims, truths);
  for (ScanRecord& scan : scans)
    if (scan.claimed) scan.T_map_body = T_truth_estimate * scan.T_map_body;
  return T_truth_estimate;
}

/// What is left of `error` without its part in the span of `directions`.
Eigen::Vector3d outside_of(const std::vector<Eigen::Vector3d>& directions, Eigen::Vector3d error) {
  std::vector<Eigen::Vector3d> basis;
  for (Eigen::Vector3d direction : directions) {
    for (const Eigen::Vector3d& known : basis) direction -= direction.dot(known) * known;
    if (direction.norm() < 1e-3) continue;
    basis.push_back(direction.normalized());
    error -= error.dot(basis.back()) * basis.back();
  }
  return error;
}

void measure_errors(double warm_up_s, std::vector<ScanRecord>& scans) {
  const TimeNs counts_from = scans.front().t + from_seconds(warm_up_s);
  for (ScanRecord& scan : scans) {
    scan.counts = scan.t >= counts_from;
    if (!scan.has_error()) continue;
    const SE3& truth = scan.truth.T_map_body;
    const Eigen::Vector3d error = scan.T_map_body.translation - truth.translation;
    scan.trans_error_m = error.norm();
    scan.undeclared_error_m = outside_of(scan.weak_directions, error).norm();
    scan.rot_error_deg =
        so3::angle_between(scan.T_map_body.rotation, truth.rotation) * 180 / std::numbers::pi;
  }
}

void count_scans(const std::vector<ScanRecord>& scans, Evaluation& result) {
  std::vector<double> trans_m;
  std::vector<double> rot_deg;
  result.scans = scans.size();
  for (const ScanRecord& scan : scans) {
    if (!scan.claimed) continue;
    ++result.claimed;
    if (scan.truth.kind == TruthSample::Kind::kOutside) ++result.outside_truth;
    if (scan.truth.kind == TruthSample::Kind::kGap) ++result.in_truth_gap;
    if (!scan.truth.known()) continue;
    trans_m.push_back(scan.trans_error_m);
    rot_deg.push_back(scan.rot_error_deg);
  }
  result.judged = trans_m.size();
  result.trans_m = error_statistics(trans_m);
  result.rot_deg = error_statistics(rot_deg);
}

void measure_shares(const EvaluationOptions& options, const std::vector<ScanRecord>& scans,
                    Evaluation& result) {
  for (const ScanRecord& scan : scans) {
    if (!scan.counts) continue;
    const bool trusted = scan.claimed && status_is_trusted(scan.status);
    result.coverage.add(scan.claimed);
    result.trusted.add(trusted);
    if (!scan.truth.known()) continue;
    result.success.add(options.success.holds(scan));
    result.misleading.add(is_misleading(scan, options.misleading));
  }
}

/// The last scan that has truth; scans after the end of the truth cannot be judged.
void measure_end(const std::vector<ScanRecord>& scans, Evaluation& result) {
  for (auto scan = scans.rbegin(); scan != scans.rend(); ++scan) {
    if (!scan->truth.known()) continue;
    if (!scan->claimed) return;
    result.e2e_m = scan->trans_error_m;
    result.e2e_deg = scan->rot_error_deg;
    return;
  }
}

void score_what_happened(const EvaluationOptions& options, const RunContext& context,
                         const TruthTrack& truth, const std::vector<ScanRecord>& scans,
                         Evaluation& result) {
  result.events = score_events(context.events, scans, truth, options.success, options.misleading);
  result.relocalizations = score_relocalizations(context.run_events, scans);
  for (const RelocalizationScore& score : result.relocalizations) {
    const bool wrong = score.trans_error_m > options.misleading.trans_m ||
                       score.rot_error_deg > options.misleading.rot_deg;
    if (wrong) ++result.false_relocalizations;
  }
}

void warn(std::size_t number, std::string_view what, Evaluation& result) {
  if (number > 0) result.warnings.push_back(fmt::format("{}: {}", what, number));
}

void collect_warnings(const ScanList& list, const RunContext& context, Evaluation& result) {
  if (!context.steps.empty() && !list.from_steps)
    result.warnings.push_back("steps.csv has no time in common with the estimate and was not used");
  warn(result.outside_truth, "claims outside the time of the truth, not judged", result);
  warn(result.in_truth_gap, "claims in gaps of the truth, not judged", result);
  warn(list.claims_without_row, "claims without a row in steps.csv, taken for TRACKING", result);
  warn(list.repeated_claims, "claims that repeat the stamp of the one before, left out", result);
  std::size_t untold = 0;
  for (const ScanRecord& scan : list.scans)
    if (scan.claimed && !status_claims_pose(scan.status)) ++untold;
  warn(untold, "claims in a status that makes none", result);
  std::size_t unscored = 0;
  for (const Event& event : context.events)
    if (!is_simulated_event(event.name)) ++unscored;
  warn(unscored, "events of a kind that is not scored", result);
}

}  // namespace

Result<Evaluation> evaluate(const Trajectory& estimate, const Trajectory& truth_poses,
                            const EvaluationOptions& options, const RunContext& context) {
  const TruthTrack truth(truth_poses, options.max_truth_gap_s);
  if (const auto problem = find_time_problem(estimate, truth, context)) return *problem;
  ScanList list = scans_due(estimate, truth, context);
  Evaluation result;
  look_up_truth(truth, list.scans);
  if (options.align == Alignment::kRigid) result.T_truth_estimate = align_claims(list.scans);
  measure_errors(options.warm_up_s, list.scans);
  result.align = options.align;
  result.from_steps = list.from_steps;
  result.begin = list.scans.front().t;
  result.end = list.scans.back().t;
  result.path_m = truth.length_m();
  result.truth_period_s = truth.period_s();
  count_scans(list.scans, result);
  measure_shares(options, list.scans, result);
  measure_end(list.scans, result);
  constexpr std::array<double, 3> kDriftLengths_m = {10, 20, 50};
  for (std::size_t i = 0; i < kDriftLengths_m.size(); ++i)
    result.drift[i] = relative_error(list.scans, kDriftLengths_m[i], context.is_odometry);
  score_what_happened(options, context, truth, list.scans, result);
  collect_warnings(list, context, result);
  result.series = std::move(list.scans);
  return result;
}

}  // namespace holdfast::evaluation
