#include "holdfast/filter/map_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace holdfast::filter {

using registration::kPosition;
using registration::kRotation;
using registration::kVelocity;

void marginalise(const MapError& error, registration::NormalEquations& e) {
  registration::Matrix9d S = e.H;
  const auto add = [&S](int block, double sigma) {
    S.diagonal().segment<3>(block).array() += 1.0 / (sigma * sigma);
  };
  S.block<3, 3>(kPosition, kPosition) += error.position.inverse();
  add(kRotation, error.rotation_rad);
  add(kVelocity, error.velocity_m_s);
  const Eigen::LDLT<registration::Matrix9d> solver(S);
  const registration::Matrix9d H = e.H;
  e.g -= H * solver.solve(e.g);
  e.H -= H * solver.solve(H);
  e.H = (0.5 * (e.H + e.H.transpose())).eval();
}

void fix_velocity(registration::NormalEquations& e) {
  e.H.middleRows<3>(kVelocity).setZero();
  e.H.middleCols<3>(kVelocity).setZero();
  e.g.segment<3>(kVelocity).setZero();
}

}  // namespace holdfast::filter
