#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "holdfast/filter/filter_state.hpp"

namespace holdfast::odometry {

/// A jump of both biases some scans ago, in the order [accelerometer, gyroscope].
struct BiasJump {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  Vector6d size = Vector6d::Zero();
  Matrix6d P = Matrix6d::Identity();
  int age = 0;  ///< scans
  /// What a jump of one made of the errors (truth minus estimate) of the state now and at the scan
  /// before, and of gravity.
  Eigen::Matrix<double, 15, 6> now;
  Eigen::Matrix<double, 15, 6> before;
  Eigen::Matrix<double, 3, 6> gravity;
};

/// Did the biases jump? Beside the filter's own, it is kept what a jump at the end of each of the
/// last scans would have made of the state (the second stage of Friedland, "Treatment of bias in
/// recursive filtering", 1969), and how likely that makes the innovations since, against no jump
/// (generalised likelihood ratio of Willsky and Jones, 1976).
///
/// A jump is one constant that goes on: it is believed where it explains nearly all that was
/// surprising since, over several scans of which most agrees as usual, and is of a size that jumps
/// have. Only directions that the scans determine well are heard: along a corridor a crowd that
/// walks together looks like an acceleration.
class BiasJumpWatch {
 public:
  void clear() { count_ = 0; }

  /// The state went on from `before` to `predicted` by the IMU alone, at the end of a scan of
  /// `span_s`: what that sees is bent by a wrong velocity and rate.
  void carry(const filter::FilterState& before, const filter::FilterState& predicted,
             const Eigen::Vector3d& gravity, double span_s);
  /// A scan corrected `predicted` to `after`; `share` of its points agree, by the usual one.
  void hear(const filter::FilterState& predicted, const filter::FilterState& after, double share);
  /// Of the state's errors `left` is what remained, I - K H; gravity followed them by `gain`.
  void correct(const filter::Matrix15d& left, const Eigen::Matrix<double, 3, 15>& gain);
  /// The errors of the state are now `change` times what they were.
  void change_errors(const filter::Matrix15d& change);

  /// The jump that is to be believed, if any.
  std::optional<BiasJump> believed() const;

 private:
  static constexpr std::size_t kOnsets = 12;

  /// A jump at the end of one scan.
  struct Onset {
    BiasJump jump;  ///< without size and covariance
    BiasJump::Matrix6d information;
    BiasJump::Vector6d gradient;
    double squares = 0;      ///< sum of squared innovations since, by their covariance
    double least_share = 1;  ///< of points that agree, since
    int scans = 0;           ///< that were heard since
  };

  static BiasJump fit(const Onset& onset);

  std::array<Onset, kOnsets> onsets_;
  std::size_t count_ = 0;  ///< of onsets, the oldest first
  double age_s_ = 0;       ///< of the newest scan's points at its end, in the mean
};

}  // namespace holdfast::odometry
