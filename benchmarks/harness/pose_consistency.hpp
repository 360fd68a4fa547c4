#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace holdfast::benchmarks {

/// Limits between which 95 % of the values lie.
struct Band {
  double low = 0, high = 0;

  bool holds(double value) const { return low <= value && value <= high; }
};

/// The middle 95 % of a chi-square distribution of `degrees` of freedom, an even number >= 2.
Band chi_square_band_95(int degrees);

/// Errors of poses beside the covariances that were claimed for them. NEES: the squared error by
/// its covariance, which is 1 for each dimension on average where the covariance is right, more
/// where it promises too much.
class PoseConsistency {
 public:
  static constexpr int kDimensions = 6;
  using Error = Eigen::Matrix<double, kDimensions, 1>;
  using Covariance = Eigen::Matrix<double, kDimensions, kDimensions>;

  /// One instant: the error as [position, rotation] with its covariance, in axes of one frame.
  void add(const Error& error, const Covariance& covariance);
  void add(const PoseConsistency& other);

  std::size_t instants() const { return squares_.size(); }
  /// Mean squared error along an axis by its variance; NaN for no instants, as the others.
  double of_axis(int axis) const;
  /// NEES of a dimension, on average.
  double of_position() const;
  double of_rotation() const;
  double of_pose() const;
  /// Share of the instants whose NEES lies in the band of 6 degrees of freedom.
  double share_in_band() const;
  /// Squared Mahalanobis distance of the whole pose, at each instant.
  const std::vector<double>& squares() const { return squares_; }

 private:
  double mean(double sum, int dimensions) const;

  std::array<double, kDimensions> axes_{};
  double position_ = 0, rotation_ = 0;
  std::vector<double> squares_;
};

}  // namespace holdfast::benchmarks
