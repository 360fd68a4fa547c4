#pragma once

namespace holdfast::simulation {

/// The LiDAR's clock against the IMU's, which shows the true time. Sizes are drawn once a seed.
struct LidarClockModel {
  double offset_sigma_s = 0;  ///< what it is ahead at the start of the log
  double drift_sigma_ppm = 0;
  double jitter_sigma_s = 0;  ///< of each scan's stamp, on its own
  double jump_least_s = 0.02;
  double jump_most_s = 0.1;  ///< size of a clock_jump, forwards or back

  bool is_true() const {
    return offset_sigma_s == 0 && drift_sigma_ppm == 0 && jitter_sigma_s == 0;
  }
};

/// Messages that do not arrive, alone or in runs (a Markov chain of two states).
struct LossModel {
  double lost_share = 0;  ///< of all, 0 to 0.5
  double mean_run = 1;    ///< messages lost in a row, on average
};

/// What happens to measurements between sensor and log. All off by default.
struct TransportModel {
  LidarClockModel lidar_clock;
  LossModel lidar_packets;
  int columns_per_packet = 24;  ///< as of an RS-LiDAR-16 and a VLP-16: 12 blocks of 2 firings
  LossModel imu_samples;

  /// A LiDAR that is stamped by its own quartz, set to the host's time over the network: 5 ms off
  /// (sigma), 20 ppm (a usual tolerance of quartzes), 0.5 ms of jitter. Chosen, without a source.
  static LidarClockModel unsynchronised_clock();

  /// Of a busy network and serial port: 2 % of LiDAR packets in runs of 3, 1 % of IMU samples in
  /// runs of 2. Chosen, without a source.
  TransportModel with_losses() const;
};

}  // namespace holdfast::simulation
