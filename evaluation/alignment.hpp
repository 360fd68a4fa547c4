#pragma once

#include <vector>

#include "holdfast/core/se3.hpp"

namespace holdfast::evaluation {

/// The rigid transform T_truth_estimate that brings the poses of `estimate` closest to those of
/// `truth` (same length, at least one pair): Umeyama (PAMI 1991) without scale, over positions.
/// Where positions leave a rotation open (a straight drive, a robot that only turned), the
/// orientations decide: each enters with a lever of 1 cm, too little to move a solution that the
/// positions determine.
SE3 align_rigid(const std::vector<SE3>& estimate, const std::vector<SE3>& truth);

}  // namespace holdfast::evaluation
