#pragma once

#include "holdfast/estimator/fixed_lag_smoother.hpp"
#include "tests/estimator/scene.hpp"

/// A robot on a smooth path in closed form: readings, pose observations and odometry whose noise is
/// exactly what the estimator assumes.
namespace holdfast::estimator::testing {

constexpr int kPerScan = 20;  ///< readings between two nodes, 5 ms each

struct ChainOptions {
  int nodes = 30;
  filter::ImuNoiseConfig imu{1e-3, 1e-2, 1e-4, 1e-3};
  double gravity_sigma = 0.05;
  double position_sigma_m = 0.005;
  double rotation_sigma_rad = 0.001;
  double odometry_sigma_m = 0.003;  ///< and a third of it as an angle
  int jump_in_interval = -1;        ///< where the biases jump by 0.3 m/s^2 and 0.03 rad/s
};

/// A pose observed with noise, as the map residual of a node.
struct PoseObservation {
  SE3 T_map_body;
  double position_sigma_m = 1;
  double rotation_sigma_rad = 1;

  MapFactor at(const NodeState& x) const;
};

/// Node k > 0 has segment, increment and observation k; node 0 has the start.
struct Chain {
  ChainOptions options;
  std::vector<NodeState> truth;
  NodeState start;
  Matrix18d start_covariance;
  std::vector<preprocess::ImuSegment> imu;
  std::vector<OdometryIncrement> odometry;
  std::vector<PoseObservation> observed;

  SmootherConfig config(int window = 10) const {
    SmootherConfig c;
    c.window = window;
    c.noise.imu = options.imu;
    c.gravity_walk = 1e-4;
    return c;
  }
};

/// Biases are constant over each interval and walk at the nodes, as the factors have it.
Chain simulate(std::uint64_t seed, const ChainOptions& options = {});

/// Runs the smoother over a chain up to node `nodes`, with a word on `each`.
void run(const Chain& chain, FixedLagSmoother& smoother, bool with_odometry, int nodes,
         const std::function<void(int, const OptimiseReport&)>& each = nullptr);

}  // namespace holdfast::estimator::testing
