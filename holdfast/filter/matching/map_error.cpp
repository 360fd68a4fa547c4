#include "holdfast/filter/matching/map_error.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::filter {

using registration::Matrix9d;

void marginalise(const MapError& error, ScanEquations& e) {
  auto& [H, g] = e;
  Matrix9d S = H.topLeftCorner<9, 9>();
  S.topLeftCorner<6, 6>() += error.pose.llt().solve(Matrix6d::Identity());
  S.diagonal().segment<3>(FilterState::kV).array() += 1.0 / std::pow(error.velocity_m_s, 2);
  const Eigen::LDLT<Matrix9d> solver(S);
  const Eigen::Matrix<double, 15, 9> cross = H.leftCols<9>();
  g -= cross * solver.solve(e.g.head<9>());
  H -= cross * solver.solve(cross.transpose());
  H = (0.5 * (H + H.transpose())).eval();
}

void fix_velocity(ScanEquations& e) {
  e.H.middleRows<3>(FilterState::kV).setZero();
  e.H.middleCols<3>(FilterState::kV).setZero();
  e.g.segment<3>(FilterState::kV).setZero();
}

}  // namespace holdfast::filter
