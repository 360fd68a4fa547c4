#include "evaluation/truth_track.hpp"

#include <algorithm>
#include <utility>

#include "evaluation/statistics.hpp"

namespace holdfast::evaluation {
namespace {

constexpr double kLongestInterpolationSeconds = 0.25;
/// Steps shorter than this are gathered before they count as way, so that the noise of a truth at
/// rest does not add up.
constexpr double kPathStepMetres = 0.02;

double median_period_s(const Trajectory& poses) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < poses.size(); ++i)
    if (poses[i].t > poses[i - 1].t) periods.push_back(to_seconds(poses[i].t - poses[i - 1].t));
  return periods.empty() ? 0 : median(std::move(periods));
}

}  // namespace

TruthTrack::TruthTrack(Trajectory poses, double max_gap_s)
    : poses_(std::move(poses)), period_s_(median_period_s(poses_)) {
  const double slow_truth_s = std::min(1.5 * period_s_, kLongestInterpolationSeconds);
  max_gap_ = from_seconds(std::max(max_gap_s, slow_truth_s));
  measure_path();
}

bool TruthTrack::broken_after(std::size_t i) const {
  const TimeNs pause = poses_[i + 1].t - poses_[i].t;
  return pause == 0 || pause > max_gap_;
}

void TruthTrack::measure_path() {
  path_m_.resize(poses_.size(), 0);
  stretch_.resize(poses_.size(), 0);
  std::size_t anchor = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    const bool broken = broken_after(i - 1);
    stretch_[i] = stretch_[i - 1] + (broken ? 1 : 0);
    path_m_[i] = path_m_[i - 1];
    if (broken) anchor = i;
    const double step =
        (poses_[i].T_map_body.translation - poses_[anchor].T_map_body.translation).norm();
    if (step < kPathStepMetres) continue;
    path_m_[i] = path_m_[anchor] + step;
    anchor = i;
  }
}

TruthSample TruthTrack::sample_of(std::size_t i) const {
  return {TruthSample::Kind::kKnown, poses_[i].T_map_body, path_m_[i], stretch_[i]};
}

TruthSample TruthTrack::at(TimeNs t) const {
  const auto later = std::upper_bound(poses_.begin(), poses_.end(), t,
                                      [](TimeNs time, const StampedPose& p) { return time < p.t; });
  if (later == poses_.begin()) return {};
  const auto i = static_cast<std::size_t>(later - poses_.begin()) - 1;
  if (poses_[i].t == t) return sample_of(i);
  if (later == poses_.end()) return {};
  if (broken_after(i)) {
    TruthSample gap;
    gap.kind = TruthSample::Kind::kGap;
    return gap;
  }
  const double u = to_seconds(t - poses_[i].t) / to_seconds(later->t - poses_[i].t);
  TruthSample sample = sample_of(i);
  sample.T_map_body = interpolate(poses_[i].T_map_body, later->T_map_body, u);
  sample.path_m += u * (path_m_[i + 1] - path_m_[i]);
  return sample;
}

}  // namespace holdfast::evaluation
