#include "holdfast/odometry/edges/edge_ways.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace holdfast::odometry {
namespace {

constexpr float kAlike = 0.9F;        // cosine of directions of one edge
constexpr float kAcrossM = 0.15F;     // farther edges are others
constexpr float kAlongM = 0.5F;       // where the next beam has seen the same edge
constexpr double kEdgeSigmaM = 0.02;  // of columns that see an edge, beside the fit's own error
constexpr double kRobustScale = 3.0;
constexpr double kFeignedShare = 0.05;  // of the information about the best known direction
constexpr double kVoteCellM = 0.1;
constexpr float kUpright = 0.9F;
constexpr double kCommonSigmaM = 0.01;  // error that all edges of a scan have in common
constexpr int kIterations = 3;

/// Of `d` what is at right angles to `direction`.
Eigen::Vector3f across(const Eigen::Vector3f& d, const Eigen::Vector3f& direction) {
  return d - direction.dot(d) * direction;
}

/// Directions of edges are a little off: together, edges that are all parallel seem to tell
/// something along themselves. What they tell far less about than about another direction is left
/// out.
void take_out_feigned(EdgeWays::Fit& fit) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(fit.H);
  const double least = kFeignedShare * solver.eigenvalues()[2];
  Eigen::Matrix3d told = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d u = solver.eigenvectors().col(i);
    if (solver.eigenvalues()[i] >= least) told += u * u.transpose();
  }
  fit.H = (told * fit.H * told).eval();
  fit.g = (told * fit.g).eval();
}

/// Counts votes for ways in a square of cells.
class Ballot {
 public:
  explicit Ballot(double longest_m)
      : half_(static_cast<int>(std::ceil(longest_m / kVoteCellM)) + 1),
        side_(2 * half_ + 1),
        votes_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  void vote(const Eigen::Vector3f& way) {
    const int i = static_cast<int>(std::lround(way.x() / kVoteCellM));
    const int j = static_cast<int>(std::lround(way.y() / kVoteCellM));
    if (std::abs(i) <= half_ && std::abs(j) <= half_) ++at(i, j);
  }

  /// The cell that has most votes with its neighbours; none of it may be elected again.
  bool elect(Eigen::Vector3d& way) {
    int most = 2, best_i = 0, best_j = 0;
    for (int i = 1 - half_; i < half_; ++i) {
      for (int j = 1 - half_; j < half_; ++j) {
        const int votes = around(i, j);
        if (votes <= most) continue;
        most = votes;
        best_i = i;
        best_j = j;
      }
    }
    if (most == 2) return false;
    for (int k = 0; k < 9; ++k) at(best_i + k % 3 - 1, best_j + k / 3 - 1) = 0;
    way = {kVoteCellM * best_i, kVoteCellM * best_j, 0};
    return true;
  }

 private:
  int& at(int i, int j) {
    return votes_[static_cast<std::size_t>((i + half_) * side_ + j + half_)];
  }
  int around(int i, int j) {
    int sum = 0;
    for (int k = 0; k < 9; ++k) sum += at(i + k % 3 - 1, j + k / 3 - 1);
    return sum;
  }

  int half_, side_;
  std::vector<int> votes_;
};

}  // namespace

EdgeWays::EdgeWays(std::vector<EdgePoint> first, std::vector<EdgePoint> second)
    : first_(std::move(first)), second_(std::move(second)) {
  std::stable_sort(first_.begin(), first_.end(), [](const EdgePoint& a, const EdgePoint& b) {
    return a.position.x() < b.position.x();
  });
}

std::vector<Eigen::Vector3d> EdgeWays::votes(double longest_m, std::size_t most) const {
  Ballot ballot(longest_m);
  for (const EdgePoint& b : second_) {
    if (std::abs(b.direction.z()) < kUpright) continue;
    for (const EdgePoint& a : first_) {
      if (std::abs(a.direction.dot(b.direction)) < kAlike) continue;
      const Eigen::Vector3f d = a.position - b.position;
      if (std::abs(d.z()) < kAlongM) ballot.vote(across(d, a.direction));
    }
  }
  std::vector<Eigen::Vector3d> ways;
  Eigen::Vector3d way;
  while (ways.size() < most && ballot.elect(way)) ways.push_back(way);
  return ways;
}

/// The nearest edge of the first scan to `edge`, moved to `at`.
const EdgePoint* EdgeWays::partner(const EdgePoint& edge, const Eigen::Vector3f& at) const {
  constexpr float kReach = kAcrossM + kAlongM;
  const EdgePoint* nearest = nullptr;
  float least_sq = kAcrossM * kAcrossM;
  auto a = std::lower_bound(first_.begin(), first_.end(), at.x() - kReach,
                            [](const EdgePoint& e, float x) { return e.position.x() < x; });
  for (; a != first_.end() && a->position.x() < at.x() + kReach; ++a) {
    const Eigen::Vector3f d = at - a->position;
    if (std::abs(a->direction.dot(edge.direction)) < kAlike) continue;
    if (std::abs(a->direction.dot(d)) > kAlongM) continue;
    const float distance_sq = across(d, a->direction).squaredNorm();
    if (distance_sq >= least_sq) continue;
    least_sq = distance_sq;
    nearest = &*a;
  }
  return nearest;
}

EdgeWays::Fit EdgeWays::fit(const Eigen::Vector3d& way) const {
  constexpr double kMost = kRobustScale * kRobustScale;
  Fit fit;
  for (const EdgePoint& b : second_) {
    const Eigen::Vector3f at = b.position + way.cast<float>();
    const EdgePoint* a = partner(b, at);
    if (a == nullptr) {
      fit.cost += kMost;
      continue;
    }
    const Eigen::Vector3d u = a->direction.cast<double>();
    const Eigen::Vector3d r = across(at - a->position, a->direction).cast<double>();
    const double information =
        1.0 / (a->sigma_m * a->sigma_m + b.sigma_m * b.sigma_m + kEdgeSigmaM * kEdgeSigmaM);
    const double sigmas_sq = information * r.squaredNorm();
    const double weight = std::pow(kMost / (kMost + sigmas_sq), 2);
    fit.cost += kMost * sigmas_sq / (kMost + sigmas_sq);
    fit.weight += weight;
    fit.H += weight * information * (Eigen::Matrix3d::Identity() - u * u.transpose());
    fit.g += weight * information * r;
  }
  take_out_feigned(fit);
  return fit;
}

EdgeWays::Told EdgeWays::refine(const Eigen::Vector3d& way, const Eigen::Matrix3d& P) const {
  Told told;
  for (int i = 0; i < kIterations; ++i) {
    const Fit at = fit(way + told.moved);
    const Eigen::Matrix3d share =
        (Eigen::Matrix3d::Identity() + kCommonSigmaM * kCommonSigmaM * at.H).inverse();
    told.information = share * at.H;
    told.weight = at.weight;
    // (P^-1 + H) d = -(P^-1 moved + g), without inverting P.
    const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() + P * told.information;
    told.moved -= A.partialPivLu().solve(told.moved + P * (share * at.g));
  }
  return told;
}

}  // namespace holdfast::odometry
