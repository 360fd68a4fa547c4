#include "holdfast/preprocess/imu_buffer.hpp"

#include <algorithm>

namespace holdfast::preprocess {
namespace {

bool earlier(const ImuSample& sample, TimeNs t) { return sample.t < t; }

}  // namespace

ImuBuffer::Verdict ImuBuffer::add(const ImuSample& sample) {
  if (!sample.gyro_rad_s.allFinite() || !sample.accel_m_s2.allFinite()) {
    ++not_finite_;
    return Verdict::kNotFinite;
  }
  if (!samples_.empty() && sample.t <= samples_.back().t) {
    ++out_of_order_;
    return Verdict::kOutOfOrder;
  }
  samples_.push_back(sample);
  return Verdict::kTaken;
}

ImuSample ImuBuffer::at(TimeNs t) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t, earlier);
  ImuSample result;
  if (after == samples_.end()) {
    result = samples_.back();
  } else if (after == samples_.begin()) {
    result = *after;
  } else {
    const ImuSample& a = *(after - 1);
    const double u = static_cast<double>(t - a.t) / static_cast<double>(after->t - a.t);
    result.gyro_rad_s = (1 - u) * a.gyro_rad_s + u * after->gyro_rad_s;
    result.accel_m_s2 = (1 - u) * a.accel_m_s2 + u * after->accel_m_s2;
  }
  result.t = t;
  return result;
}

bool ImuBuffer::segment(TimeNs begin, TimeNs end, ImuSegment& out) const {
  out.samples.clear();
  out.held_ns = 0;
  out.longest_gap_ns = 0;
  if (samples_.empty()) return false;
  out.samples.push_back(at(begin));
  auto it = std::lower_bound(samples_.begin(), samples_.end(), begin + 1, earlier);
  for (; it != samples_.end() && it->t < end; ++it) {
    out.longest_gap_ns = std::max(out.longest_gap_ns, it->t - out.samples.back().t);
    out.samples.push_back(*it);
  }
  if (end > begin) {
    out.longest_gap_ns = std::max(out.longest_gap_ns, end - out.samples.back().t);
    out.samples.push_back(at(end));
  }
  const TimeNs uncovered_front = std::clamp<TimeNs>(samples_.front().t - begin, 0, end - begin);
  const TimeNs uncovered_back = std::clamp<TimeNs>(end - samples_.back().t, 0, end - begin);
  out.measured_begin = samples_.front().t;
  out.measured_end = samples_.back().t;
  out.held_ns = std::min(uncovered_front + uncovered_back, end - begin);
  return true;
}

void ImuBuffer::drop_before(TimeNs t) {
  while (samples_.size() > 1 && samples_[1].t <= t) samples_.pop_front();
}

}  // namespace holdfast::preprocess
