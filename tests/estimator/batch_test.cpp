#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Cholesky>

#include "tests/estimator/simulated_chain.hpp"

/// The window against all nodes at once, solved by Ceres with residuals written down again and
/// differentiated automatically.
namespace holdfast::estimator {
namespace {

using testing::Chain;
using testing::ChainOptions;

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

/// exp of Ceres, on Eigen's quaternions.
template <class T>
Eigen::Quaternion<T> exp_of(const Vec3<T>& phi) {
  T wxyz[4];
  ceres::AngleAxisToQuaternion(phi.data(), wxyz);
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

template <class T>
Vec3<T> log_of(const Eigen::Quaternion<T>& q) {
  const T wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  Vec3<T> phi;
  ceres::QuaternionToAngleAxis(wxyz, phi.data());
  return phi;
}

/// A node as an offset from where it is linearised.
template <class T>
struct Node {
  Node(const NodeState& x, const T* d)
      : q(x.T_map_body.rotation.cast<T>() * exp_of<T>(Vec3<T>(d[3], d[4], d[5]))),
        p(x.T_map_body.translation.cast<T>() + Vec3<T>(d[0], d[1], d[2])),
        v(x.v_map.cast<T>() + Vec3<T>(d[6], d[7], d[8])),
        ba(x.accel_bias.cast<T>() + Vec3<T>(d[9], d[10], d[11])),
        bg(x.gyro_bias.cast<T>() + Vec3<T>(d[12], d[13], d[14])),
        g(x.gravity_map.cast<T>() + Vec3<T>(d[15], d[16], d[17])) {}

  Eigen::Quaternion<T> q;
  Vec3<T> p, v, ba, bg, g;
};

struct StartCost {
  const NodeState& start;
  const Matrix18d& covariance;  ///< diagonal
  const NodeState& x;

  template <class T>
  bool operator()(const T* d, T* r) const {
    const Node<T> n(x, d);
    Eigen::Map<Eigen::Matrix<T, 18, 1>> out(r);
    out.template segment<3>(0) = n.p - start.T_map_body.translation.cast<T>();
    out.template segment<3>(3) =
        log_of<T>(start.T_map_body.rotation.conjugate().template cast<T>() * n.q);
    out.template segment<3>(6) = n.v - start.v_map.cast<T>();
    out.template segment<3>(9) = n.ba - start.accel_bias.cast<T>();
    out.template segment<3>(12) = n.bg - start.gyro_bias.cast<T>();
    out.template segment<3>(15) = n.g - start.gravity_map.cast<T>();
    for (int i = 0; i < 18; ++i) r[i] /= std::sqrt(covariance(i, i));
    return true;
  }
};

struct ImuCost {
  Preintegration imu;
  WalkSigmas walk;
  const NodeState &xi, &xj;
  Matrix9d whitening;

  template <class T>
  bool operator()(const T* di, const T* dj, T* r) const {
    const Node<T> i(xi, di), j(xj, dj);
    const T dt(imu.seconds());
    Eigen::Matrix<T, 6, 1> moved;
    moved.template head<3>() = i.ba - imu.accel_bias().cast<T>();
    moved.template tail<3>() = i.bg - imu.gyro_bias().cast<T>();
    const Eigen::Matrix<T, 9, 1> change = imu.bias_jacobian().cast<T>() * moved;
    Eigen::Matrix<T, 9, 1> e;
    e.template segment<3>(0) = i.q.conjugate() * (j.p - i.p - i.v * dt - i.g * (dt * dt * 0.5)) -
                               imu.increment().position.cast<T>() - change.template segment<3>(0);
    e.template segment<3>(3) = log_of<T>(
        (imu.increment().rotation.cast<T>() * exp_of<T>(Vec3<T>(change.template segment<3>(3))))
            .conjugate() *
        i.q.conjugate() * j.q);
    e.template segment<3>(6) = i.q.conjugate() * (j.v - i.v - i.g * dt) -
                               imu.increment().velocity.cast<T>() - change.template segment<3>(6);
    Eigen::Map<Eigen::Matrix<T, 18, 1>> out(r);
    out.template head<9>() = whitening.cast<T>() * e;
    out.template segment<3>(9) = (j.ba - i.ba) / T(walk.accel_bias);
    out.template segment<3>(12) = (j.bg - i.bg) / T(walk.gyro_bias);
    out.template segment<3>(15) = (j.g - i.g) / T(walk.gravity);
    return true;
  }
};

struct PoseCost {
  const testing::PoseObservation& z;
  const NodeState& x;

  template <class T>
  bool operator()(const T* d, T* r) const {
    const Node<T> n(x, d);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(r);
    out.template head<3>() = (n.p - z.T_map_body.translation.cast<T>()) / T(z.position_sigma_m);
    out.template tail<3>() = log_of<T>(z.T_map_body.rotation.conjugate().template cast<T>() * n.q) /
                             T(z.rotation_sigma_rad);
    return true;
  }
};

struct OdometryCost {
  const OdometryIncrement& odometry;
  const NodeState &xi, &xj;

  template <class T>
  bool operator()(const T* di, const T* dj, T* r) const {
    const Node<T> i(xi, di), j(xj, dj);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(r);
    const SE3& z = odometry.T_prev_cur;
    out.template head<3>() = i.q.conjugate() * (j.p - i.p) - z.translation.cast<T>();
    out.template tail<3>() =
        log_of<T>(z.rotation.conjugate().template cast<T>() * i.q.conjugate() * j.q);
    for (int k = 0; k < 6; ++k) r[k] /= std::sqrt(odometry.covariance(k, k));
    return true;
  }
};

/// All nodes of a chain and what is known of them.
class Batch {
 public:
  Batch(const Chain& chain, bool with_odometry)
      : chain_(chain), with_odometry_(with_odometry), x_(chain.truth) {
    // Offsets are taken anew from each optimum, so that in the end they and the curvature of their
    // chart vanish.
    for (int round = 0; round < 3; ++round) solve(round == 2);
  }

  const NodeState& newest() const { return x_.back(); }
  const Matrix18d& covariance() const { return covariance_; }

 private:
  void add_costs(ceres::Problem& problem) {
    using ceres::AutoDiffCostFunction;
    problem.AddResidualBlock(new AutoDiffCostFunction<StartCost, 18, 18>(
                                 new StartCost{chain_.start, chain_.start_covariance, x_[0]}),
                             nullptr, offsets_[0].data());
    const SmootherConfig config = chain_.config();
    for (std::size_t k = 1; k < x_.size(); ++k) {
      Preintegration imu;
      imu.integrate(chain_.imu[k], x_[k - 1].accel_bias, x_[k - 1].gyro_bias, config.noise);
      const double root = std::sqrt(imu.seconds());
      const WalkSigmas walk{config.noise.imu.accel_bias_walk * root,
                            config.noise.imu.gyro_bias_walk * root, config.gravity_walk * root};
      const Matrix9d information = imu.covariance().llt().solve(Matrix9d::Identity());
      double* const i = offsets_[k - 1].data();
      double* const j = offsets_[k].data();
      problem.AddResidualBlock(new AutoDiffCostFunction<ImuCost, 18, 18, 18>(new ImuCost{
                                   imu, walk, x_[k - 1], x_[k], information.llt().matrixU()}),
                               nullptr, i, j);
      problem.AddResidualBlock(
          new AutoDiffCostFunction<PoseCost, 6, 18>(new PoseCost{chain_.observed[k], x_[k]}),
          nullptr, j);
      if (!with_odometry_) continue;
      problem.AddResidualBlock(new AutoDiffCostFunction<OdometryCost, 6, 18, 18>(
                                   new OdometryCost{chain_.odometry[k], x_[k - 1], x_[k]}),
                               nullptr, i, j);
    }
  }

  void solve(bool with_covariance) {
    offsets_.assign(x_.size(), Vector18d::Zero());
    ceres::Problem problem;
    add_costs(problem);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.function_tolerance = options.parameter_tolerance = 1e-15;
    options.max_num_iterations = 20;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    ASSERT_TRUE(summary.IsSolutionUsable()) << summary.BriefReport();
    for (std::size_t k = 0; k < x_.size(); ++k) x_[k].add(offsets_[k]);
    if (with_covariance) set_covariance(problem);
  }

  void set_covariance(ceres::Problem& problem) {
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::SPARSE_QR;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    ceres::Covariance covariance(options);
    const double* last = offsets_.back().data();
    const std::vector<std::pair<const double*, const double*>> blocks = {{last, last}};
    ASSERT_TRUE(covariance.Compute(blocks, &problem));
    ASSERT_TRUE(covariance.GetCovarianceBlock(last, last, covariance_.data()));  // symmetric
  }

  const Chain& chain_;
  bool with_odometry_;
  std::vector<NodeState> x_;
  std::vector<Vector18d> offsets_;
  Matrix18d covariance_ = Matrix18d::Zero();
};

class AgainstABatch : public ::testing::TestWithParam<bool> {};

TEST_P(AgainstABatch, TheWindowIsAsGoodAsAllNodesAtOnce) {
  double largest = 0, largest_share = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Chain chain = testing::simulate(seed);
    FixedLagSmoother smoother(chain.config());
    run(chain, smoother, GetParam(), 30);
    const Batch batch(chain, GetParam());
    const Eigen::LLT<Matrix18d> llt(batch.covariance());
    const Vector18d off = llt.matrixL().solve(smoother.newest().minus(batch.newest()));
    const Matrix18d half = llt.matrixL().solve(smoother.covariance_of_newest());
    const Matrix18d ratio = llt.matrixL().solve(half.transpose());
    const double share = (ratio - Matrix18d::Identity()).cwiseAbs().maxCoeff();
    largest = std::max(largest, off.norm());
    largest_share = std::max(largest_share, share);
  }
  // What differs is the curvature of marginalised nodes and of the first-order bias correction: a
  // share as large as the turn, in radians, that a node still makes after it was marginalised, some
  // sigmas of its observed rotation.
  const double tolerance = 5 * ChainOptions{}.rotation_sigma_rad;
  EXPECT_LT(largest, tolerance);
  EXPECT_LT(largest_share, tolerance);
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithOdometry, AgainstABatch, ::testing::Bool());

}  // namespace
}  // namespace holdfast::estimator
