#include "holdfast/pipeline/event_sequencer.hpp"

#include <algorithm>

namespace holdfast::pipeline {

void EventSequencer::push(SensorEvent event) {
  if (auto* imu = std::get_if<ImuSample>(&event)) {
    imu_until_ = std::max(imu_until_, imu->t);
    log_until_ = std::max(log_until_, imu->t);
    ready_.push_back(std::move(event));
  } else {
    Scan& scan = std::get<Scan>(event);
    log_until_ = std::max(log_until_, scan.end_time);
    const auto later = [](TimeNs t, const Scan& s) { return t < s.end_time; };
    waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), scan.end_time, later),
                    std::move(scan));
  }
  while (!waiting_.empty() && scan_is_ready(waiting_.front())) {
    ready_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

bool EventSequencer::scan_is_ready(const Scan& scan) const {
  return imu_until_ >= scan.end_time || log_until_ >= scan.end_time + patience_;
}

bool EventSequencer::pop(SensorEvent& event) {
  if (ready_.empty() && finished_ && !waiting_.empty()) {
    ready_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  if (ready_.empty()) return false;
  event = std::move(ready_.front());
  ready_.pop_front();
  return true;
}

}  // namespace holdfast::pipeline
