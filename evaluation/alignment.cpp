#include "evaluation/alignment.hpp"

#include <Eigen/SVD>
#include <cassert>

namespace holdfast::evaluation {
namespace {

constexpr double kOrientationLeverMetres = 0.01;

Eigen::Vector3d mean_position(const std::vector<SE3>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SE3& pose : poses) sum += pose.translation;
  return sum / static_cast<double>(poses.size());
}

}  // namespace

SE3 align_rigid(const std::vector<SE3>& estimate, const std::vector<SE3>& truth) {
  assert(estimate.size() == truth.size() && !estimate.empty());
  const Eigen::Vector3d mean_estimate = mean_position(estimate);
  const Eigen::Vector3d mean_truth = mean_position(truth);
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();  // Umeyama eq. 38, times n
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    moment +=
        (truth[i].translation - mean_truth) * (estimate[i].translation - mean_estimate).transpose();
    moment += kOrientationLeverMetres * kOrientationLeverMetres *
              truth[i].rotation.toRotationMatrix() *
              estimate[i].rotation.toRotationMatrix().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moment, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  SE3 T_truth_estimate;
  T_truth_estimate.rotation = Eigen::Quaterniond(rotation).normalized();
  T_truth_estimate.translation = mean_truth - T_truth_estimate.rotation * mean_estimate;
  return T_truth_estimate;
}

}  // namespace holdfast::evaluation
