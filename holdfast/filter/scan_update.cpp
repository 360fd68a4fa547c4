#include "holdfast/filter/scan_update.hpp"

#include <Eigen/Cholesky>

namespace holdfast::filter {
namespace {

using registration::kPosition;
using registration::kRotation;

// A change below which another iteration would change nothing that matters.
constexpr double kConvergedM = 1e-4;
constexpr double kConvergedRad = 1e-5;
constexpr double kLeastWeight = 30.0;

MatchState match_state_of(const FilterState& s, const Eigen::Vector3d& gravity) {
  return {s.T_map_body, s.v_map, s.accel_bias, s.gyro_bias, gravity};
}

/// d(x [-] prior)/d(error): the identity but for the rotation.
Matrix15d chart_jacobian(const Vector15d& difference) {
  Matrix15d J = Matrix15d::Identity();
  J.block<3, 3>(FilterState::kR, FilterState::kR) =
      so3::right_jacobian_inverse(difference.segment<3>(FilterState::kR));
  return J;
}

Matrix15d inverse_of(const Matrix15d& m) { return m.ldlt().solve(Matrix15d::Identity()); }

/// Information and gradient of prior and scan together at `state`.
struct System {
  Matrix15d A;
  Vector15d b;

  System(const FilterState& prior, const Matrix15d& prior_information, const FilterState& state,
         const ScanEquations& scan) {
    const Vector15d difference = state.minus(prior);
    const Matrix15d J = chart_jacobian(difference);
    A = J.transpose() * prior_information * J + scan.H;
    b = J.transpose() * (prior_information * difference) + scan.g;
  }
};

bool is_small(const Vector15d& delta) {
  return delta.segment<3>(kPosition).norm() < kConvergedM &&
         delta.segment<3>(kRotation).norm() < kConvergedRad;
}

}  // namespace

UpdateResult update_with_scan(const ScanPairing& map, const SelectedScan& scan,
                              const Eigen::Vector3d& gravity, const UpdateOptions& options,
                              WorkerPool& pool, UpdateWorkspace& work, const FilterState& prior,
                              FilterState& state, StageClock* clock) {
  ScanMatch match(map, scan, options, pool, work, clock);
  const Matrix15d prior_information = inverse_of(prior.P);
  Matrix15d information = prior_information;
  UpdateResult result;
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    const ScanEquations softened =
        match.linearise(match_state_of(state, gravity), options.motion_from_skew);
    result.usable = match.raw().weight >= kLeastWeight;
    if (!result.usable) break;
    const System system(prior, prior_information, state, softened);
    information = system.A;
    const Vector15d delta = -system.A.ldlt().solve(system.b);
    state.add(delta);
    if (result.iterations + 1 >= ScanMatch::kCalls && is_small(delta)) break;
  }
  result.equations = match.raw();
  if (result.usable) {
    state.P = inverse_of(information);
    state.P = (0.5 * (state.P + state.P.transpose())).eval();
  }
  if (clock != nullptr) clock->book(Stage::kSolve);
  return result;
}

}  // namespace holdfast::filter
