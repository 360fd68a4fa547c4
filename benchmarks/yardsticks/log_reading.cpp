#include "benchmarks/yardsticks/log_reading.hpp"

#include "holdfast/core/stage_clock.hpp"
#include "holdfast/io/log_file.hpp"

namespace holdfast::benchmarks {

Result<std::vector<double>> time_reading(const std::filesystem::path& log) {
  auto reader = io::open_log(log, {});
  if (!reader) return reader.error();
  std::vector<double> times;
  double last = thread_cpu_ms();
  while (true) {
    const auto event = (*reader)->next();
    if (!event) return event.error();
    if (!event->has_value()) return times;
    if (!std::holds_alternative<Scan>(**event)) continue;
    const double now = thread_cpu_ms();
    times.push_back(now - last);
    last = now;
  }
}

}  // namespace holdfast::benchmarks
