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

/// Information (1/m^2, map frame) about the position that a scan only seems to hold, along the
/// principal directions of what it seems to hold:
/// - Normals are off by some milliradians and give every direction a share of the information of
///   the others, which vanishes as soon as the points are paired anew.
/// - Where a handful of pairs speaks for a direction, some of them may be points of a wall beside
///   the jamb that they are paired with: a point that is chosen for being near a plane always
///   votes for staying where it is. N effective pairs, N = (sum I)^2 / sum I^2, count for
///   1 / (1 + (few_pairs/N)^2) of their information. In tunnels, where this was measured, squared
///   errors of single scans are 58, 8, 6, 1 to 3, 0.7, and 0.6 times their variance without it for
///   N about 2.5, 4, 6.5, 8 to 20, 30 and 60: few_pairs is about 20.
/// `e` are the equations of `pairs` at `T_anchor_body` with `robust_scale`.
Eigen::Matrix3d feigned_information(const NormalEquations& e, const Correspondences& pairs,
                                    const SE3& T_anchor_body, double robust_scale,
                                    double few_pairs);

/// Covariance (m^2, map frame) of a position offset that takes `e.feigned` away: marginalising an
/// offset with this covariance leaves what is real.
Eigen::Matrix3d feigned_offset(const NormalEquations& e);

/// Unit vectors of the map frame, the weakest first, of which few pairs tell: less than a twentieth
/// of what is told about the best known direction.
std::vector<Eigen::Vector3d> few_told_directions(const NormalEquations& e);

/// Unit vectors of the map frame, the weakest first, along which one scan determines the position
/// worse than `sigma_m`, the rotation being free and `e.feigned` taken off.
std::vector<Eigen::Vector3d> weak_directions(const NormalEquations& e, double sigma_m);

}  // namespace holdfast::registration
