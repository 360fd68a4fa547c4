#include "simulation/transport/losses.hpp"

#include <algorithm>
#include <string>

namespace holdfast::simulation {

std::vector<bool> draw_losses(const LossModel& model, std::size_t count, RandomStream random) {
  std::vector<bool> lost(count, false);
  if (model.lost_share == 0) return lost;
  const double ends = 1 / model.mean_run;
  const double begins = ends * model.lost_share / (1 - model.lost_share);
  bool is_lost = random.uniform() < model.lost_share;
  for (std::size_t i = 0; i < count; ++i) {
    lost[i] = is_lost;
    is_lost = is_lost ? random.uniform() >= ends : random.uniform() < begins;
  }
  return lost;
}

std::size_t lose_packets(Scan& scan, const RevolutionPackets& packets, const TransportModel& model,
                         std::uint64_t seed) {
  if (model.lidar_packets.lost_share == 0) return 0;
  const auto columns = static_cast<std::size_t>(packets.columns);
  const auto each = static_cast<std::size_t>(model.columns_per_packet);
  const auto lost =
      draw_losses(model.lidar_packets, (columns + each - 1) / each,
                  RandomStream(seed, "lidar.packets." + std::to_string(packets.index)));
  const auto is_lost = [&](const ScanPoint& point) {
    const TimeNs since = scan.stamp + point.time_offset_ns - packets.begin;
    // The column that began last before the point was fired.
    const auto column = static_cast<std::size_t>(
        std::clamp<TimeNs>((since + 1) * packets.columns / packets.period, 0, packets.columns - 1));
    return lost[column / each];
  };
  std::erase_if(scan.points, is_lost);
  const std::size_t count = static_cast<std::size_t>(std::count(lost.begin(), lost.end(), true));
  if (scan.points.empty()) {
    scan.stamp = packets.begin;
    scan.end_time = packets.begin + packets.period;
    return count;
  }
  const std::int32_t first = scan.points.front().time_offset_ns;
  for (ScanPoint& point : scan.points) point.time_offset_ns -= first;
  scan.stamp += first;
  scan.end_time = scan.stamp + scan.points.back().time_offset_ns;
  return count;
}

}  // namespace holdfast::simulation
