#include "evaluation/event_scores.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace holdfast::evaluation {
namespace {

constexpr TimeNs kHold = 2 * kSecond;
constexpr std::size_t kHoldScans = 18;
/// Times in events.jsonl are rounded a little, so a teleport is looked at from this far away.
constexpr TimeNs kStampSlack = kSecond / 1000;
constexpr std::array<std::string_view, 7> kSimulatedEvents = {
    "kidnap", "blind", "lidar_off", "imu_off", "imu_bias_jump", "clock_jump", "crowd"};

using ScanIterator = std::vector<ScanRecord>::const_iterator;

ScanIterator first_scan_at(const std::vector<ScanRecord>& scans, TimeNs t) {
  return std::lower_bound(scans.begin(), scans.end(), t,
                          [](const ScanRecord& scan, TimeNs time) { return scan.t < time; });
}

/// Lasting changes are over the moment they happen; the others when they end.
TimeNs recovery_starts(const Event& event) {
  const bool lasting = event.name == "imu_bias_jump" || event.name == "clock_jump";
  return lasting ? event.t0 : event.t1;
}

TimeNs next_kidnap_after(const std::vector<Event>& events, const Event& event) {
  TimeNs next = std::numeric_limits<TimeNs>::max();
  for (const Event& other : events)
    if (other.name == "kidnap" && other.t0 > event.t1) next = std::min(next, other.t0);
  return next;
}

/// First scan of [first, last) from which on all scans are good for 2 s and 18 scans; last if none.
ScanIterator first_lasting(ScanIterator first, ScanIterator last, const PoseTolerance& success) {
  ScanIterator begin = first;
  for (ScanIterator scan = first; scan != last; ++scan) {
    if (scan->status != "TRACKING" || !success.holds(*scan)) {
      begin = scan + 1;
      continue;
    }
    const auto held = static_cast<std::size_t>(scan - begin) + 1;
    if (scan->t - begin->t >= kHold && held >= kHoldScans) return begin;
  }
  return last;
}

void measure_move(const TruthTrack& truth, EventScore& score) {
  const TruthSample before = truth.at(score.event.t0 - kStampSlack);
  const TruthSample after = truth.at(score.event.t1 + kStampSlack);
  if (!before.known() || !after.known()) return;
  score.moved_m = (after.T_map_body.translation - before.T_map_body.translation).norm();
  score.moved_deg = so3::angle_between(before.T_map_body.rotation, after.T_map_body.rotation) *
                    180 / std::numbers::pi;
}

void measure_damage(ScanIterator first, ScanIterator last, const PoseTolerance& misleading,
                    EventScore& score) {
  for (ScanIterator scan = first; scan != last; ++scan) {
    if (!score.noticed_after_s && !status_is_trusted(scan->status))
      score.noticed_after_s = to_seconds(scan->t - score.event.t0);
    if (!scan->has_error()) continue;
    score.worst_claim_m = std::fmax(score.worst_claim_m, scan->trans_error_m);
    if (is_misleading(*scan, misleading)) ++score.misleading_scans;
  }
}

EventScore score_event(const Event& event, TimeNs limit, const std::vector<ScanRecord>& scans,
                       const TruthTrack& truth, const PoseTolerance& success,
                       const PoseTolerance& misleading) {
  EventScore score;
  score.event = event;
  if (event.name == "kidnap") measure_move(truth, score);
  const TimeNs start = recovery_starts(event);
  const ScanIterator last = first_scan_at(scans, limit);
  const ScanIterator recovered = first_lasting(first_scan_at(scans, start), last, success);
  if (recovered != last) score.recovery_s = to_seconds(recovered->t - start);
  measure_damage(first_scan_at(scans, event.t0), recovered, misleading, score);
  return score;
}

}  // namespace

bool is_misleading(const ScanRecord& scan, const PoseTolerance& tolerance) {
  if (!scan.has_error() || !status_is_trusted(scan.status)) return false;
  return scan.undeclared_error_m > tolerance.trans_m || scan.rot_error_deg > tolerance.rot_deg;
}

bool is_simulated_event(const std::string& name) {
  return std::find(kSimulatedEvents.begin(), kSimulatedEvents.end(), name) !=
         kSimulatedEvents.end();
}

std::vector<EventScore> score_events(const std::vector<Event>& events,
                                     const std::vector<ScanRecord>& scans, const TruthTrack& truth,
                                     const PoseTolerance& success,
                                     const PoseTolerance& misleading) {
  std::vector<EventScore> scores;
  for (const Event& event : events) {
    if (!is_simulated_event(event.name)) continue;
    const TimeNs limit = next_kidnap_after(events, event);
    scores.push_back(score_event(event, limit, scans, truth, success, misleading));
  }
  return scores;
}

std::vector<RelocalizationScore> score_relocalizations(const std::vector<Event>& run_events,
                                                       const std::vector<ScanRecord>& scans) {
  std::vector<RelocalizationScore> scores;
  for (const Event& event : run_events) {
    if (event.name != "relocalized") continue;
    RelocalizationScore score;
    score.t = event.t0;
    for (ScanIterator scan = first_scan_at(scans, event.t0 - kStampSlack);
         scan != scans.end() && scan->t <= event.t0 + kSecond; ++scan) {
      if (!scan->has_error()) continue;
      score.trans_error_m = scan->trans_error_m;
      score.rot_error_deg = scan->rot_error_deg;
      break;
    }
    scores.push_back(score);
  }
  return scores;
}

}  // namespace holdfast::evaluation
