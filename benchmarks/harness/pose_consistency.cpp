#include "benchmarks/harness/pose_consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "evaluation/statistics.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr double kTail = 0.025;

/// P(X > x): for an even number of degrees the tail of a Poisson distribution of mean x/2.
double chi_square_tail(double x, int degrees) {
  double sum = 0;
  for (int k = 0; k < degrees / 2; ++k) {
    sum += std::exp(-x / 2 + k * std::log(x / 2) - std::lgamma(k + 1.0));
  }
  return sum;
}

/// The value that is exceeded with this probability.
double chi_square_exceeded(double probability, int degrees) {
  double low = 0;
  double high = 10.0 * degrees + 100.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (chi_square_tail(middle, degrees) > probability ? low : high) = middle;
  }
  return low;
}

template <int kSize>
double square_of(const PoseConsistency::Error& error, const PoseConsistency::Covariance& covariance,
                 int first) {
  const Eigen::Matrix<double, kSize, 1> e = error.segment<kSize>(first);
  const Eigen::Matrix<double, kSize, kSize> P = covariance.block<kSize, kSize>(first, first);
  return e.dot(P.ldlt().solve(e));
}

}  // namespace

Band chi_square_band_95(int degrees) {
  assert(degrees >= 2 && degrees % 2 == 0);
  return {chi_square_exceeded(1 - kTail, degrees), chi_square_exceeded(kTail, degrees)};
}

void PoseConsistency::add(const Error& error, const Covariance& covariance) {
  for (int i = 0; i < kDimensions; ++i) {
    axes_[static_cast<std::size_t>(i)] += error[i] * error[i] / covariance(i, i);
  }
  position_ += square_of<3>(error, covariance, 0);
  rotation_ += square_of<3>(error, covariance, 3);
  squares_.push_back(square_of<kDimensions>(error, covariance, 0));
}

void PoseConsistency::add(const PoseConsistency& other) {
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i] += other.axes_[i];
  position_ += other.position_;
  rotation_ += other.rotation_;
  squares_.insert(squares_.end(), other.squares_.begin(), other.squares_.end());
}

double PoseConsistency::mean(double sum, int dimensions) const {
  if (squares_.empty()) return evaluation::kNotKnown;
  return sum / static_cast<double>(squares_.size()) / dimensions;
}

double PoseConsistency::of_axis(int axis) const {
  return mean(axes_[static_cast<std::size_t>(axis)], 1);
}

double PoseConsistency::of_position() const { return mean(position_, 3); }

double PoseConsistency::of_rotation() const { return mean(rotation_, 3); }

double PoseConsistency::of_pose() const {
  return mean(std::accumulate(squares_.begin(), squares_.end(), 0.0), kDimensions);
}

double PoseConsistency::share_in_band() const {
  const Band band = chi_square_band_95(kDimensions);
  const auto inside = [&](double square) { return band.holds(square); };
  return mean(static_cast<double>(std::count_if(squares_.begin(), squares_.end(), inside)), 1);
}

}  // namespace holdfast::benchmarks
