#pragma once

#include <ctime>

#include "holdfast/core/step_report.hpp"

namespace holdfast {

/// CPU time of the calling thread, ms.
inline double thread_cpu_ms() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Wall time, ms, from an arbitrary start.
inline double wall_ms() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Books the time since the last call under a stage. Only measures: no result depends on it.
class StageClock {
 public:
  explicit StageClock(StageTimes& times)
      : times_(times), cpu_start_(thread_cpu_ms()), cpu_last_(cpu_start_), wall_start_(wall_ms()) {}
  ~StageClock() {
    times_.total_ms = thread_cpu_ms() - cpu_start_;
    times_.wall_ms = wall_ms() - wall_start_;
  }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  /// What was done since the last call was `stage`.
  void book(Stage stage) {
    const double now = thread_cpu_ms();
    times_.ms[static_cast<std::size_t>(stage)] += now - cpu_last_;
    cpu_last_ = now;
  }

 private:
  StageTimes& times_;
  double cpu_start_;
  double cpu_last_;
  double wall_start_;
};

}  // namespace holdfast
