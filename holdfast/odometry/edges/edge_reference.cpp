#include "holdfast/odometry/edges/edge_reference.hpp"

#include <Eigen/Cholesky>

#include "holdfast/odometry/edges/edge_ways.hpp"

namespace holdfast::odometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using filter::FilterState;

constexpr double kCommonSigmaM = 0.01;  // error that all edges of a scan have in common
constexpr double kLeastShare = 0.4;     // of the edges that a reference has to know
constexpr double kLeastWeight = 8;      // edges that must agree
constexpr int kIterations = 3;

}  // namespace

void EdgeReference::correct(const std::vector<SeenEdge>& edges, const filter::SelectedScan& scan,
                            const Vector3d& gravity, FilterState& state) {
  std::vector<EdgePoint> put = put_edges(
      edges, scan, {state.T_map_body, state.v_map, state.accel_bias, state.gyro_bias, gravity});
  double known = 0;
  if (!edges_.empty()) {
    const EdgeWays ways(edges_, put);
    const Vector3d predicted = state.T_map_body.translation - p_odom_;
    const Matrix3d P = state.P.topLeftCorner<3, 3>();
    // All scans that meet one reference share its errors: the later ones tell less that is new.
    const double part = 1.0 / ++scans_;
    Vector3d way = predicted;
    Matrix3d information = Matrix3d::Zero();
    for (int i = 0; i < kIterations; ++i) {
      const EdgeWays::Fit fit = ways.fit(way);
      const Matrix3d share =
          part *
          (Matrix3d::Identity() + kCommonSigmaM * kCommonSigmaM * fit.H).inverse();
      information = share * fit.H;
      // (P^-1 + H) d = -(P^-1 (way - predicted) + g), without inverting P.
      const Matrix3d A = Matrix3d::Identity() + P * information;
      way -= A.partialPivLu().solve(way - predicted + P * (share * fit.g));
      known = fit.weight;
    }
    if (known >= kLeastWeight) {
      // All of the state follows the position by their covariance.
      const Eigen::Matrix<double, 15, 3> cross = state.P.leftCols<3>();
      const Matrix3d A = Matrix3d::Identity() + P * information;
      const Vector3d moved = way - predicted;
      const filter::Vector15d delta = cross * P.ldlt().solve(moved);
      const Matrix3d lost = information * A.inverse();
      state.P -= cross * lost * cross.transpose();
      state.P = (0.5 * (state.P + state.P.transpose())).eval();
      state.add(delta);
    }
  }
  if (known >= kLeastShare * static_cast<double>(put.size()) && known >= kLeastWeight) return;
  edges_ = std::move(put);
  scans_ = 0;
  p_odom_ = state.T_map_body.translation;
}

}  // namespace holdfast::odometry
