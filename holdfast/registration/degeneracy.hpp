#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/registration/normal_equations.hpp"

/// Which directions a scan does not determine. All information here is whitened, i.e. divided by
/// the variance of each residual: its eigenvalues are 1 / m^2 and 1 / sigma^2 of the position along
/// the eigenvector, so that a limit is a length, not a number of points.
namespace holdfast::registration {

/// Information (1/m^2, map frame) that one scan holds about the position when nothing else tells
/// the rotation: the Schur complement of the rotation. Rotations that the scan does not determine
/// (about the normal of an open plane, about the axis of a round tunnel) are left out, since no
/// residual depends on them. Velocity is taken as known.
Eigen::Matrix3d position_information(const Matrix9d& H);

/// Covariance (m^2, map frame) of a position offset that takes away the information which the scan
/// only seems to hold: normals are off by some milliradians and give every direction a share of the
/// information of the others, which vanishes as soon as the points are paired anew. Marginalising
/// an offset with this covariance leaves what is real.
Eigen::Matrix3d feigned_offset(const Matrix9d& H);

/// Unit vectors of the map frame, the weakest first, along which one scan determines the position
/// worse than `sigma_m`, the rotation being free. Normals of a map are off by some milliradians,
/// which gives every direction a share of the information of the others that the scene does not
/// hold: that share is taken off before the comparison.
std::vector<Eigen::Vector3d> weak_directions(const Matrix9d& H, double sigma_m);

}  // namespace holdfast::registration
