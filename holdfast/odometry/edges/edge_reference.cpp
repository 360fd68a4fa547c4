#include "holdfast/odometry/edges/edge_reference.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "holdfast/odometry/edges/edge_ways.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using filter::FilterState;

constexpr double kCommonSigmaM = 0.01;  // error that all edges of a scan have in common
// All scans that meet one reference share its errors, and how an edge is seen changes with the
// place: squared errors of many scans together, by those of as many that know nothing of each
// other.
constexpr double kAlike = 10;
constexpr double kLeastShare = 0.25;  // of the edges that a reference has to know
constexpr double kLeastWeight = 8;    // edges that must agree
constexpr int kIterations = 3;

/// What edges say about a position.
struct Told {
  Vector3d moved = Vector3d::Zero();
  Matrix3d information = Matrix3d::Zero();
  double weight = 0;
};

/// `P`: covariance of the position that `way` leads to.
Told ask(const EdgeWays& ways, const Vector3d& way, const Matrix3d& P) {
  Told told;
  for (int i = 0; i < kIterations; ++i) {
    const EdgeWays::Fit fit = ways.fit(way + told.moved);
    const Matrix3d share =
        (Matrix3d::Identity() + kCommonSigmaM * kCommonSigmaM * fit.H).inverse() / kAlike;
    told.information = share * fit.H;
    told.weight = fit.weight;
    // (P^-1 + H) d = -(P^-1 moved + g), without inverting P.
    const Matrix3d A = Matrix3d::Identity() + P * told.information;
    told.moved -= A.partialPivLu().solve(told.moved + P * (share * fit.g));
  }
  return told;
}

/// All of the state follows its position by their covariance.
void apply(const Told& told, FilterState& state) {
  const Eigen::Matrix<double, 15, 3> of_position = state.P.leftCols<3>();
  const Matrix3d P = of_position.topRows<3>();
  const filter::Vector15d delta = of_position * P.ldlt().solve(told.moved);
  const Matrix3d& H = told.information;
  state.P -= of_position * (H * (Matrix3d::Identity() + P * H).inverse()) * of_position.transpose();
  state.P = (0.5 * (state.P + state.P.transpose())).eval();
  state.add(delta);
}

}  // namespace

void EdgeReference::correct(const std::vector<SeenEdge>& edges, const filter::SelectedScan& scan,
                            const Vector3d& gravity, FilterState& state) {
  std::vector<EdgePoint> put = put_edges(
      edges, scan, {state.T_map_body, state.v_map, state.accel_bias, state.gyro_bias, gravity});
  if (!edges_.empty()) {
    const Told told = ask(EdgeWays(edges_, put), state.T_map_body.translation - p_odom_,
                          state.P.topLeftCorner<3, 3>());
    const double least = std::max(kLeastWeight, kLeastShare * static_cast<double>(put.size()));
    if (told.weight >= least) {
      apply(told, state);
      return;
    }
  }
  edges_ = std::move(put);
  p_odom_ = state.T_map_body.translation;
}

}  // namespace holdfast::odometry
