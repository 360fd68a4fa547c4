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
using filter::Matrix15d;

constexpr double kReferenceSigmaM = 0.01;  // error of the reference's edges, in common
constexpr double kLeastShare = 0.25;       // of the edges that a reference has to know
constexpr double kLeastWeight = 8;         // edges that must agree

Matrix3d position_of(const Matrix15d& P) { return P.topLeftCorner<3, 3>(); }

}  // namespace

void EdgeReference::begin(std::vector<EdgePoint> edges, const Vector3d& p_odom) {
  edges_ = std::move(edges);
  p_odom_ = p_odom;
  P_way_ = kReferenceSigmaM * kReferenceSigmaM * Matrix3d::Identity();
  cross_.setZero();
  with_before_.setZero();
}

/// r grows by what the position's error grows by.
void EdgeReference::follow(const Matrix15d& P_before, const Matrix15d& P_now,
                           const Matrix15d& now_before) {
  if (edges_.empty()) return;
  // Given the errors before, those now know nothing of r.
  const Eigen::Matrix<double, 15, 3> carried = now_before * P_before.ldlt().solve(cross_);
  with_before_ = cross_.transpose() + now_before.topRows<3>() - P_before.topRows<3>();
  const Matrix3d grown = carried.topRows<3>() - cross_.topRows<3>();
  const Matrix3d mixed = position_of(now_before);
  P_way_ += grown + grown.transpose() + position_of(P_now) + position_of(P_before) - mixed -
            mixed.transpose();
  P_way_ = (0.5 * (P_way_ + P_way_.transpose())).eval();
  cross_ = carried + P_now.leftCols<3>() - now_before.leftCols<3>();
}

void EdgeReference::correct(const std::vector<SeenEdge>& edges, const filter::SelectedScan& scan,
                            const Vector3d& gravity, FilterState& state, Matrix15d& now_before) {
  std::vector<EdgePoint> put = put_edges(
      edges, scan, {state.T_map_body, state.v_map, state.accel_bias, state.gyro_bias, gravity});
  const Vector3d p = state.T_map_body.translation;
  if (edges_.empty()) return begin(std::move(put), p);
  const EdgeWays::Told told = EdgeWays(edges_, put).refine(p - p_odom_, P_way_);
  const double least = std::max(kLeastWeight, kLeastShare * static_cast<double>(put.size()));
  if (told.weight < least) return begin(std::move(put), p);

  const Matrix3d& H = told.information;
  state.add(cross_ * P_way_.ldlt().solve(told.moved));
  // What of the way's error is none of the state's now: the map around moved on with it.
  p_odom_ += state.T_map_body.translation - p - told.moved;
  const Matrix3d gain = H * (Matrix3d::Identity() + P_way_ * H).inverse();
  now_before -= cross_ * gain * with_before_;
  state.P -= cross_ * gain * cross_.transpose();
  state.P = (0.5 * (state.P + state.P.transpose())).eval();
  cross_ -= (cross_ * gain * P_way_).eval();
  P_way_ -= (P_way_ * gain * P_way_).eval();
  P_way_ = (0.5 * (P_way_ + P_way_.transpose())).eval();
}

void EdgeReference::allow_for(const BiasJump& jump) {
  const Eigen::Matrix<double, 3, 6> way = jump.now.topRows<3>();
  P_way_ += way * jump.P * way.transpose();
  P_way_ = (0.5 * (P_way_ + P_way_.transpose())).eval();
  cross_ += jump.now * jump.P * way.transpose();
}

}  // namespace holdfast::odometry
