#include "holdfast/filter/scan_update.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::filter {
namespace {

using registration::kPosition;
using registration::kRotation;
using registration::kVelocity;
using registration::Matrix9d;
using registration::NormalEquations;
using registration::Vector9d;

// Changes below which another iteration, pairing or deskewing would change nothing that matters.
constexpr double kConvergedM = 1e-4;
constexpr double kConvergedRad = 1e-5;
constexpr double kRepairM = 0.02;
constexpr double kRepairRad = 0.002;
constexpr double kRedeskewM = 0.002;
constexpr double kLeastWeight = 30.0;
// The robust loss starts wide and narrows: far from the optimum its narrow form hardly feels the
// pairs that are off, and takes many small steps.
constexpr std::array<double, 3> kAnneal = {4.0, 2.0, 1.0};

preprocess::EndState end_state(const FilterState& s, const Eigen::Vector3d& gravity) {
  const Eigen::Quaterniond R_body_map = s.T_map_body.rotation.conjugate();
  return {R_body_map * s.v_map, R_body_map * gravity, s.gyro_bias, s.accel_bias};
}

void deskew(const SelectedScan& scan, const FilterState& state, const Eigen::Vector3d& gravity,
            UpdateWorkspace& work) {
  const Scan& s = *scan.scan;
  work.motion.set(scan.imu, end_state(state, gravity), scan.T_body_lidar, s.stamp, s.end_time);
  work.points.resize(scan.selected.size());
  const auto span_s = static_cast<float>(to_seconds(s.end_time - s.stamp));
  for (std::size_t i = 0; i < scan.selected.size(); ++i) {
    const ScanPoint& p = s.points[scan.selected[i]];
    work.points.points[i] = work.motion.deskew(p);
    work.points.age_s[i] = static_cast<float>(p.time_offset_ns) * 1e-9F - span_s;
  }
}

/// d(x [-] prior)/d(error): the identity but for the rotation.
Matrix15d chart_jacobian(const Vector15d& difference) {
  Matrix15d J = Matrix15d::Identity();
  J.block<3, 3>(FilterState::kR, FilterState::kR) =
      so3::right_jacobian_inverse(difference.segment<3>(FilterState::kR));
  return J;
}

SE3 anchored(const FilterState& state, const ScanPairing& map) {
  return {state.T_map_body.rotation, state.T_map_body.translation - map.anchor()};
}

bool moved(const FilterState& a, const FilterState& b, double metres, double radians) {
  return (a.T_map_body.translation - b.T_map_body.translation).norm() > metres ||
         so3::angle_between(a.T_map_body.rotation, b.T_map_body.rotation) > radians;
}

/// The iteration's own state: where points were deskewed and paired, and the prior.
class Iteration {
 public:
  Iteration(const ScanPairing& map, const SelectedScan& scan, const Eigen::Vector3d& gravity,
            const UpdateOptions& options, WorkerPool& pool, UpdateWorkspace& work,
            const FilterState& prior, FilterState& state, StageClock* clock)
      : map_(map),
        scan_(scan),
        gravity_(gravity),
        options_(options),
        pool_(pool),
        work_(work),
        state_(state),
        clock_(clock),
        prior_(prior),
        deskewed_(state),
        paired_(state),
        prior_information_(prior_.P.ldlt().solve(Matrix15d::Identity())) {}

  UpdateResult run() {
    UpdateResult result;
    redo_deskew();
    redo_pairs();
    for (; result.iterations < options_.max_iterations; ++result.iterations) {
      refresh();
      const bool converged = step(result);
      if (!result.usable || converged) break;
    }
    if (result.usable) set_covariance();
    return result;
  }

 private:
  void redo_deskew() {
    deskew(scan_, state_, gravity_, work_);
    deskewed_ = state_;
    book(Stage::kDeskew);
  }

  void redo_pairs() {
    map_.associate(anchored(state_, map_), scan_.T_body_lidar.translation, work_.points,
                   options_.association, pool_, work_.pairs);
    paired_ = state_;
    book(Stage::kAssociate);
  }

  void refresh() {
    const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
    const bool stale = (state_.v_map - deskewed_.v_map).norm() * span > kRedeskewM;
    if (stale) redo_deskew();
    if (stale || moved(state_, paired_, kRepairM, kRepairRad)) redo_pairs();
  }

  /// One Gauss-Newton step; true when it was too small to matter.
  bool step(UpdateResult& result) {
    NormalEquations& e = result.equations;
    const double anneal = kAnneal[std::min<std::size_t>(result.iterations, kAnneal.size() - 1)];
    e = registration::linearise(work_.pairs, anchored(state_, map_), anneal * options_.robust_scale,
                                pool_, work_.partials);
    result.usable = e.weight >= kLeastWeight;
    if (!result.usable) return false;
    NormalEquations softened = e;
    // The points still stand where the velocity of the last deskewing put them.
    softened.g += e.H.middleCols<3>(kVelocity) * (state_.v_map - deskewed_.v_map);
    if (!options_.velocity_from_skew) fix_velocity(softened);
    const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
    marginalise(map_error(options_, span, e), softened);
    const Vector15d difference = state_.minus(prior_);
    const Matrix15d J = chart_jacobian(difference);
    Matrix15d A = J.transpose() * prior_information_ * J;
    Vector15d b = J.transpose() * (prior_information_ * difference);
    A.topLeftCorner<9, 9>() += softened.H;
    b.head<9>() += softened.g;
    information_ = A;
    const Vector15d delta = -A.ldlt().solve(b);
    state_.add(delta);
    book(Stage::kSolve);
    return anneal == 1.0 && delta.segment<3>(kPosition).norm() < kConvergedM &&
           delta.segment<3>(kRotation).norm() < kConvergedRad;
  }

  void set_covariance() {
    state_.P = information_.ldlt().solve(Matrix15d::Identity());
    state_.P = (0.5 * (state_.P + state_.P.transpose())).eval();
    book(Stage::kSolve);
  }

  void book(Stage stage) {
    if (clock_ != nullptr) clock_->book(stage);
  }

  const ScanPairing& map_;
  const SelectedScan& scan_;
  const Eigen::Vector3d& gravity_;
  const UpdateOptions& options_;
  WorkerPool& pool_;
  UpdateWorkspace& work_;
  FilterState& state_;
  StageClock* clock_;
  FilterState prior_;
  FilterState deskewed_;
  FilterState paired_;
  Matrix15d prior_information_;
  Matrix15d information_ = Matrix15d::Zero();
};

}  // namespace

MapError map_error(const UpdateOptions& options, double span_s, const NormalEquations& equations) {
  const double variance = options.map_sigma_m * options.map_sigma_m;
  return {registration::feigned_offset(equations.H) + variance * Eigen::Matrix3d::Identity(),
          options.map_sigma_rad, 2.0 * options.map_sigma_m / std::max(span_s, 1e-3)};
}

UpdateResult update_with_scan(const ScanPairing& map, const SelectedScan& scan,
                              const Eigen::Vector3d& gravity, const UpdateOptions& options,
                              WorkerPool& pool, UpdateWorkspace& work, const FilterState& prior,
                              FilterState& state, StageClock* clock) {
  return Iteration(map, scan, gravity, options, pool, work, prior, state, clock).run();
}

}  // namespace holdfast::filter
