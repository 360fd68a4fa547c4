#include "benchmarks/detection/detection_score.hpp"

#include <algorithm>

namespace holdfast::benchmarks {
namespace {

constexpr double kTimeToFindS = 5.0;
constexpr TimeNs kEarly = kSecond;  // an alarm so long before the pose is wrong is no false one
constexpr double kMostStepS = 1.0;  // of time between scans
constexpr int kFewestMatches = 30;  // N_E + N_F (article 4.1.1)

/// The scan from which the pose is wrong; past the last: none.
std::size_t first_wrong(const MonitoredDrive& drive) {
  std::size_t i = 0;
  while (i < drive.scans.size() && !drive.scans[i].wrong) ++i;
  return i;
}

double step_s(const MonitoredDrive& drive, std::size_t i) {
  return i == 0 ? 0.0 : std::min(kMostStepS, to_seconds(drive.scans[i].t - drive.scans[i - 1].t));
}

}  // namespace

Alarms alarms_by_probability(const MonitoredDrive& drive, double threshold) {
  Alarms alarms;
  for (const ScanHealth& scan : drive.scans) alarms.push_back(scan.p_wrong >= threshold);
  return alarms;
}

Alarms alarms_by_dual_index(const MonitoredDrive& drive, const monitor::DualIndexConfig& config) {
  monitor::DualIndexDetector detector(config);
  Alarms alarms;
  for (const ScanHealth& scan : drive.scans) {
    monitor::DualIndexInput input;
    input.T_map_body = scan.T_map_body;
    input.T_map_predicted = scan.T_map_predicted;
    if (scan.matches > 0) input.mean_residual_m = scan.mean_residual_m;
    input.too_few_matches = scan.matches < kFewestMatches;
    alarms.push_back(detector.judge(input).anomaly);
  }
  return alarms;
}

void DetectionScore::add(const MonitoredDrive& drive, const Alarms& alarms) {
  const std::size_t begin = first_wrong(drive);
  const std::size_t count = drive.scans.size();
  const TimeNs wrong_from =
      begin < count ? drive.scans[begin].t : drive.scans.back().t + 2 * kEarly;
  for (std::size_t i = 0; i < begin; ++i) {
    right_s += step_s(drive, i);
    const bool raised = alarms[i] && (i == 0 || !alarms[i - 1]);
    if (raised && drive.scans[i].t < wrong_from - kEarly) ++false_alarms;
  }
  if (begin == count) return;

  const TimeNs from = drive.mishap == Mishap::kKidnap ? drive.event : wrong_from;
  double passed_s = to_seconds(wrong_from - from), misleading_s = 0;
  for (std::size_t i = begin; i < count; ++i) {
    const ScanHealth& scan = drive.scans[i];
    const bool counts = i > begin && (drive.mishap != Mishap::kWrongStart || scan.moving);
    if (counts) passed_s += step_s(drive, i);
    // An alarm that stood before the pose was wrong is one that came early.
    if (alarms[i]) {
      missed.add(false);
      delays_s.push_back(std::max(0.0, passed_s));
      return;
    }
    if (!scan.wrong) {
      missed.add(false);  // right again before anybody could say so
      delays_s.push_back(std::max(0.0, passed_s));
      return;
    }
    if (scan.trusted || !drive.scans[i].alarm) {
      ++misleading;
      misleading_s += step_s(drive, i);
      longest_misleading_s = std::max(longest_misleading_s, misleading_s);
    }
    if (passed_s > kTimeToFindS) break;
  }
  missed.add(true);
}

DetectionScore& DetectionScore::operator+=(const DetectionScore& other) {
  missed.count += other.missed.count;
  missed.of += other.missed.of;
  delays_s.insert(delays_s.end(), other.delays_s.begin(), other.delays_s.end());
  false_alarms += other.false_alarms;
  right_s += other.right_s;
  misleading += other.misleading;
  longest_misleading_s = std::max(longest_misleading_s, other.longest_misleading_s);
  return *this;
}

double DetectionScore::false_alarms_per_h() const {
  return right_s > 0 ? static_cast<double>(false_alarms) * 3600.0 / right_s : evaluation::kNotKnown;
}

}  // namespace holdfast::benchmarks
