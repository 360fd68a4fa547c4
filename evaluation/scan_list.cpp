#include "evaluation/scan_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace holdfast::evaluation {
namespace {

constexpr TimeNs kSameScan = kSecond / 1000;
constexpr double kNominalPeriodSeconds = 0.1;
constexpr double kJitter = 0.05;  ///< of a period

template <class Container, class TimeOf>
double median_period_s(const Container& items, const TimeOf& time_of) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < items.size(); ++i)
    periods.push_back(to_seconds(time_of(items[i]) - time_of(items[i - 1])));
  return periods.empty() ? kNominalPeriodSeconds : median(std::move(periods));
}

/// Claims are causal, so the first line of a stamp is the claim.
Trajectory without_repeats(const Trajectory& estimate, std::size_t& repeated) {
  Trajectory claims;
  for (const StampedPose& pose : estimate) {
    if (!claims.empty() && pose.t == claims.back().t)
      ++repeated;
    else
      claims.push_back(pose);
  }
  return claims;
}

ScanRecord claimed_scan(const StampedPose& claim) {
  ScanRecord scan;
  scan.t = claim.t;
  scan.status = "TRACKING";
  scan.claimed = true;
  scan.T_map_body = claim.T_map_body;
  return scan;
}

ScanRecord scan_of_row(const StepRow& row) {
  ScanRecord scan;
  scan.t = row.pose_time;
  scan.status = row.status;
  scan.odom_epoch = row.odom_epoch;
  if (state_of(row.status) == State::kDegraded) scan.weak_directions = row.weak_directions;
  return scan;
}

void add_unclaimed(TimeNs begin, TimeNs step, std::int64_t count, std::vector<ScanRecord>& scans) {
  for (std::int64_t i = 0; i < count; ++i) {
    ScanRecord scan;
    scan.t = begin + i * step;
    scans.push_back(scan);
  }
}

/// Whole periods in `duration`, which may be `slack` periods shorter than they are.
std::int64_t whole_periods(TimeNs duration, double period_s, double slack) {
  return static_cast<std::int64_t>(std::max(to_seconds(duration) / period_s + slack, 0.0));
}

std::int64_t scans_missing_between(TimeNs a, TimeNs b, double period_s) {
  return std::max<std::int64_t>(std::llround(to_seconds(b - a) / period_s) - 1, 0);
}

}  // namespace

ScanList scans_from_steps(const Trajectory& estimate, const std::vector<StepRow>& rows,
                          bool trust_every_claim, const TruthTrack& truth) {
  ScanList list;
  const Trajectory claims = without_repeats(estimate, list.repeated_claims);
  std::size_t next = 0;
  std::size_t matched = 0;
  const auto take_claims_before = [&](TimeNs t) {
    for (; next < claims.size() && claims[next].t < t; ++next) {
      list.scans.push_back(claimed_scan(claims[next]));
      ++list.claims_without_row;
    }
  };
  for (const StepRow& row : rows) {
    take_claims_before(row.pose_time - kSameScan);
    ScanRecord scan = scan_of_row(row);
    scan.row = &row - rows.data();
    if (next < claims.size() && claims[next].t <= row.pose_time + kSameScan) {
      scan.t = claims[next].t;
      scan.claimed = true;
      scan.T_map_body = claims[next++].T_map_body;
      if (trust_every_claim) scan.status = "TRACKING";
      ++matched;
    } else if (trust_every_claim) {
      scan.status.clear();
    }
    if (trust_every_claim) scan.weak_directions.clear();
    list.scans.push_back(std::move(scan));
  }
  take_claims_before(std::numeric_limits<TimeNs>::max());
  if (matched == 0 && !claims.empty()) return scans_from_period(estimate, truth);
  list.from_steps = true;
  list.period_s = median_period_s(rows, [](const StepRow& row) { return row.pose_time; });
  return list;
}

ScanList scans_from_period(const Trajectory& estimate, const TruthTrack& truth) {
  ScanList list;
  const Trajectory claims = without_repeats(estimate, list.repeated_claims);
  list.period_s = median_period_s(claims, [](const StampedPose& pose) { return pose.t; });
  const TimeNs period = from_seconds(list.period_s);
  const TimeNs begin = truth.begin_time();
  const TimeNs end = truth.end_time();
  if (claims.empty()) {
    add_unclaimed(begin + period, period, (end - begin) / period, list.scans);
    return list;
  }
  // Scans end after the truth's first line and not after its last; jitter is no scan.
  const std::int64_t before = whole_periods(claims.front().t - begin, list.period_s, -kJitter);
  add_unclaimed(claims.front().t - before * period, period, before, list.scans);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    list.scans.push_back(claimed_scan(claims[i]));
    if (i + 1 == claims.size()) break;
    const TimeNs pause = claims[i + 1].t - claims[i].t;
    const std::int64_t missing = scans_missing_between(claims[i].t, claims[i + 1].t, list.period_s);
    add_unclaimed(claims[i].t + pause / (missing + 1), pause / (missing + 1), missing, list.scans);
  }
  const std::int64_t after = whole_periods(end - claims.back().t, list.period_s, kJitter);
  add_unclaimed(claims.back().t + period, period, after, list.scans);
  return list;
}

}  // namespace holdfast::evaluation
