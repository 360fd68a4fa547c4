#include "simulation/sensors/lidar/lidar_faults.hpp"

namespace holdfast::simulation {

LidarFaults LidarFaults::usual() {
  LidarFaults faults;
  // Ouster's data sheet of the OS1 (second generation): +-1 cm up to 20 m, +-2 cm up to 50 m, +-5
  // cm beyond, which is 0.35 to 0.5 mm a metre. Others state one figure for all ranges.
  faults.range_noise_per_m = 0.0004;
  // Assumed: timing averages over the spot, so that half of its spread is left. At 60 degrees and
  // 20 m, with 3 mrad, that is 13 mm.
  faults.incidence_noise = 0.5;
  // Assumed: beyond a third of the pulse's length there is no return rather than a worse one.
  faults.most_range_sigma_m = 0.3;
  // Assumed: half of the noise, and a tenth of a degree between the worst beams of sixteen. That
  // makers leave such errors is known: Glennie and Lichti (2010) brought the misclosure of planes
  // to a third of it when they calibrated the lasers of an HDL-64E anew.
  faults.beam_offset_sigma_m = 0.01;
  faults.beam_angle_sigma_deg = 0.03;
  // Each device's own reach: see LidarModel::reach_at_10_percent_m.
  faults.limited_reach = true;
  // Assumed; no data sheet states it. Bags of 16-beam LiDARs miss some in a thousand returns from
  // surfaces that returned the beams around them.
  faults.dropout_share = 0.005;
  faults.mixed_pixels = true;
  // VLP-16 and RS-LiDAR-16 send the strongest return unless told otherwise (their manuals).
  faults.kept_return = "strongest";
  // Assumed: half of the mirrored beams find their way back.
  faults.ghost_share = 0.5;
  // Assumed: walls are matt; one beam in fifty comes back by way of a second face.
  faults.multipath_share = 0.02;
  return faults;
}

bool LidarFaults::none() const {
  return range_noise_per_m == 0 && incidence_noise == 0 && beam_offset_sigma_m == 0 &&
         beam_angle_sigma_deg == 0 && !limited_reach && dropout_share == 0 && !mixed_pixels &&
         ghost_share == 0 && multipath_share == 0;
}

}  // namespace holdfast::simulation
