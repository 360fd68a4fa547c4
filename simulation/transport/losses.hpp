#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/random.hpp"
#include "holdfast/core/sensor_data.hpp"
#include "simulation/transport/transport_model.hpp"

namespace holdfast::simulation {

/// Which of `count` messages in a row are lost, drawn from `random`. The chain begins in its
/// steady state; a model that loses nothing draws nothing.
std::vector<bool> draw_losses(const LossModel& model, std::size_t count, RandomStream random);

/// How the columns of a revolution travel.
struct RevolutionPackets {
  std::size_t index = 0;  ///< of the revolution; names the stream "lidar.packets.INDEX"
  TimeNs begin = 0;       ///< true time of its first column
  TimeNs period = 0;
  int columns = 0;
};

/// Takes away the points whose packets are lost. Stamp, end_time and offsets are then those of the
/// points that are left, and of an empty scan `begin` and a period later. Returns the number of
/// packets lost. To be called while the scan's times are true.
std::size_t lose_packets(Scan& scan, const RevolutionPackets& packets, const TransportModel& model,
                         std::uint64_t seed);

}  // namespace holdfast::simulation
