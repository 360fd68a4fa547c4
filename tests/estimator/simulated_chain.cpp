#include "tests/estimator/simulated_chain.hpp"

namespace holdfast::estimator::testing {
namespace {

/// What is at time `s` seconds on a path of loops at about 2 m/s and rates of about 1 rad/s.
NodeState path(double s) {
  NodeState x;
  x.t = kStart + from_seconds(s);
  x.T_map_body.translation = {3 * std::sin(0.7 * s), 2 * std::cos(0.9 * s),
                              0.3 * std::sin(1.3 * s)};
  x.v_map = {2.1 * std::cos(0.7 * s), -1.8 * std::sin(0.9 * s), 0.39 * std::cos(1.3 * s)};
  x.T_map_body.rotation =
      so3::exp({0.3 * std::sin(1.1 * s), 0.2 * std::cos(1.7 * s), 1.2 * std::sin(0.6 * s)});
  return x;
}

Vector3d path_acceleration(double s) {
  return {-1.47 * std::sin(0.7 * s), -1.62 * std::cos(0.9 * s), -0.507 * std::sin(1.3 * s)};
}

Vector3d path_rate(double s) {
  const Vector3d angle(0.3 * std::sin(1.1 * s), 0.2 * std::cos(1.7 * s), 1.2 * std::sin(0.6 * s));
  const Vector3d change(0.33 * std::cos(1.1 * s), -0.34 * std::sin(1.7 * s),
                        0.72 * std::cos(0.6 * s));
  return so3::right_jacobian(angle) * change;
}

/// Readings over one interval: means over neighbours with white noise (readings alternate about
/// it).
preprocess::ImuSegment noisy_readings(const NodeState& x, double s, RandomStream& random,
                                      const filter::ImuNoiseConfig& noise) {
  const double per_root = 1 / std::sqrt(to_seconds(kPeriod));
  Vector3d gyro = Vector3d::Zero();
  Vector3d accel = Vector3d::Zero();
  return readings(
      kPerScan,
      [&](double after) {
        const Eigen::Quaterniond R_t = path(s + after).T_map_body.rotation.conjugate();
        const ImuSample sample{
            0, path_rate(s + after) + x.gyro_bias + gyro,
            R_t * (path_acceleration(s + after) - x.gravity_map) + x.accel_bias + accel};
        gyro = 2 * random_vector(random, noise.gyro_noise_density * per_root) - gyro;
        accel = 2 * random_vector(random, noise.accel_noise_density * per_root) - accel;
        return sample;
      },
      x.t);
}

void set_start(Chain& chain, RandomStream& random) {
  Vector18d sigma;
  sigma << Vector3d::Constant(0.05), Vector3d::Constant(0.01), Vector3d::Constant(0.1),
      Vector3d::Constant(0.05), Vector3d::Constant(0.005),
      Vector3d::Constant(chain.options.gravity_sigma);
  chain.start_covariance = sigma.cwiseAbs2().asDiagonal();
  Vector18d error;
  for (int i = 0; i < 18; ++i) error[i] = random.normal(0, sigma[i]);
  chain.start = chain.truth[0];
  chain.start.add(error);
}

void observe(Chain& chain, const NodeState& before, const NodeState& x, RandomStream& random) {
  const ChainOptions& o = chain.options;
  PoseObservation z{x.T_map_body, o.position_sigma_m, o.rotation_sigma_rad};
  z.T_map_body.translation += random_vector(random, o.position_sigma_m);
  // The residual is log(z^-1 x): noise on the right of x, to first order.
  z.T_map_body.rotation =
      z.T_map_body.rotation * so3::exp(random_vector(random, o.rotation_sigma_rad));
  chain.observed.push_back(z);
  OdometryIncrement d;
  d.T_prev_cur = before.T_map_body.inverse() * x.T_map_body;
  const double turn = o.odometry_sigma_m / 3;
  d.T_prev_cur.translation += random_vector(random, o.odometry_sigma_m);
  d.T_prev_cur.rotation = d.T_prev_cur.rotation * so3::exp(random_vector(random, turn));
  d.covariance.diagonal().head<3>().setConstant(o.odometry_sigma_m * o.odometry_sigma_m);
  d.covariance.diagonal().tail<3>().setConstant(turn * turn);
  chain.odometry.push_back(d);
}

}  // namespace

MapFactor PoseObservation::at(const NodeState& x) const {
  const Vector3d p = x.T_map_body.translation - T_map_body.translation;
  const Vector3d r = so3::log(T_map_body.rotation.conjugate() * x.T_map_body.rotation);
  const Eigen::Matrix3d J = so3::right_jacobian_inverse(r);
  const double wp = 1 / (position_sigma_m * position_sigma_m);
  const double wr = 1 / (rotation_sigma_rad * rotation_sigma_rad);
  registration::NormalEquations e;
  e.H.block<3, 3>(0, 0) = wp * Eigen::Matrix3d::Identity();
  e.H.block<3, 3>(3, 3) = wr * J.transpose() * J;
  e.g.segment<3>(0) = wp * p;
  e.g.segment<3>(3) = wr * J.transpose() * r;
  e.cost = wp * p.squaredNorm() + wr * r.squaredNorm();
  return {e, x};
}

Chain simulate(std::uint64_t seed, const ChainOptions& options) {
  RandomStream random(seed, "chain");
  Chain chain{options, {}, {}, {}, {{}}, {{}}, {{}}};
  const double dt = to_seconds(kPerScan * kPeriod);
  NodeState x = path(0);
  x.gravity_map = kGravity;
  x.accel_bias = random_vector(random, 0.05);
  x.gyro_bias = random_vector(random, 0.005);
  chain.truth.push_back(x);
  set_start(chain, random);
  for (int k = 1; k < options.nodes; ++k) {
    if (k == options.jump_in_interval) {
      x.accel_bias += Vector3d(0.3, 0, 0);
      x.gyro_bias += Vector3d(0, 0.03, 0);
    }
    const NodeState before = x;
    chain.imu.push_back(noisy_readings(before, (k - 1) * dt, random, options.imu));
    x = path(k * dt);
    x.gravity_map = before.gravity_map + random_vector(random, 1e-4 * std::sqrt(dt));
    x.accel_bias =
        before.accel_bias + random_vector(random, options.imu.accel_bias_walk * std::sqrt(dt));
    x.gyro_bias =
        before.gyro_bias + random_vector(random, options.imu.gyro_bias_walk * std::sqrt(dt));
    chain.truth.push_back(x);
    observe(chain, before, x, random);
  }
  return chain;
}

void run(const Chain& chain, FixedLagSmoother& smoother, bool with_odometry, int nodes,
         const std::function<void(int, const OptimiseReport&)>& each) {
  smoother.reset(chain.start, chain.start_covariance);
  for (int k = 1; k < nodes; ++k) {
    std::optional<BetweenFactor> between;
    if (with_odometry) between.emplace(chain.odometry[k], RobustLoss::kNone, 3.0);
    smoother.push(chain.imu[k], between);
    const auto report = smoother.optimise(
        [&](const NodeState& x) { return std::optional(chain.observed[k].at(x)); });
    if (each) each(k, report);
  }
}

}  // namespace holdfast::estimator::testing
