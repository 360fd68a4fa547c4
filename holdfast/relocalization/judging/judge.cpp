#include "holdfast/relocalization/judging/judge.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "holdfast/monitor/evidence/hypotheses.hpp"
#include "holdfast/monitor/sight_lines.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::relocalization {
namespace {

using monitor::Hypothesis;

constexpr double kReachM = 6.0;       // of a place: twice the way to the next one
constexpr double kPlaceWorth = 15.0;  // looks: how far a place tells what is usual near it
constexpr float kNewestS = 0.15F;     // rays of earlier scans began elsewhere
constexpr std::size_t kRays = 240;
constexpr double kRobustScale = 3.0;
constexpr double kFewPairs = 20.0;
constexpr double kUnknownSigmaM = 10.0;
constexpr double kOpenSigmaM = 0.2;   // a direction known worse than that is not determined
constexpr double kElsewhere = 0.5;    // probability of none of the candidates, before looking

monitor::UsualLooks usual_at(const places::Place& place) {
  const double through = static_cast<double>(place.through_share);
  return {std::min(1.0, static_cast<double>(place.agreeing_share) / monitor::kUsualFitting),
          through,
          static_cast<double>(place.unmapped_share) / std::max(1e-3, 1.0 - through), kPlaceWorth};
}

monitor::SightCounts follow_rays(const map::PriorMap& map, const Sight& sight, const SE3& T) {
  const Eigen::Matrix3f R = T.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = (T.translation - map.anchor()).cast<float>();
  const Eigen::Vector3f from = R * sight.p_body_lidar.cast<float>() + t;
  std::vector<std::size_t> newest;
  for (std::size_t i = 0; i < sight.points.size(); ++i) {
    if (sight.points.age_s[i] > -kNewestS) newest.push_back(i);
  }
  const std::size_t step = std::max<std::size_t>(1, newest.size() / kRays);
  std::vector<monitor::SightLine> lines;
  for (std::size_t k = 0; k < newest.size(); k += step) {
    lines.push_back({from, R * sight.points.points[newest[k]] + t});
  }
  return monitor::follow(map, lines, {});
}

/// ln of how much likelier the looks are at a right pose than at a wrong one.
double log_odds(const monitor::Looks& seen, const monitor::UsualLooks& usual) {
  monitor::Testimony testimony{};
  monitor::testify(seen, usual, testimony);
  const auto of = [&](Hypothesis hypothesis) {
    double sum = 0;
    for (const auto& witness : testimony) sum += witness[static_cast<std::size_t>(hypothesis)];
    return sum;
  };
  const double scale = of(Hypothesis::kUsual);
  const double right = 0.6 + 0.3 * std::exp(of(Hypothesis::kChanged) - scale) +
                       0.1 * std::exp(of(Hypothesis::kCrowded) - scale);
  const double wrong = 0.5 * std::exp(of(Hypothesis::kWrongStrange) - scale) +
                       0.5 * std::exp(of(Hypothesis::kWrongAlike) - scale);
  return std::log(right) - std::log(wrong);
}

}  // namespace

std::optional<Candidate> look_from(const map::PriorMap& map, const places::Places& places,
                                   const Sight& sight, const Refined& refined) {
  const SE3& T = refined.T_map_body;
  const places::Place* place = places.nearest(T * sight.p_body_lidar, kReachM);
  if (place == nullptr) return std::nullopt;
  const SE3 T_anchor_body{T.rotation, T.translation - map.anchor()};
  const registration::NormalEquations& e = refined.equations;
  Candidate c;
  c.T_map_body = T;
  c.agreeing_share = refined.agreeing_share;
  c.seen = monitor::looks_of(e.weight, e.pairs, static_cast<double>(sight.points.size()),
                             follow_rays(map, sight, T));
  c.usual = usual_at(*place);
  c.log_odds = log_odds(c.seen, c.usual);
  const Eigen::Matrix3d feigned = registration::feigned_information(
      e, refined.pairs, T_anchor_body, kRobustScale, kFewPairs);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      registration::position_information(e.H) - feigned);
  constexpr double kLeast = 1.0 / (kUnknownSigmaM * kUnknownSigmaM);
  c.weakest_sigma_m = 1.0 / std::sqrt(std::max(solver.eigenvalues()[0], kLeast));
  registration::Matrix6d H = e.H.topLeftCorner<6, 6>();
  H.diagonal().array() += kLeast;
  c.covariance = H.ldlt().solve(registration::Matrix6d::Identity());
  return c;
}

void decide(double accept_probability, SearchReport& report) {
  auto& candidates = report.candidates;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.log_odds > b.log_odds; });
  if (candidates.empty()) {
    report.outcome = SearchOutcome::kNothing;
    report.reason = "no pose in the map explains what is seen";
    return;
  }
  const double each = (1.0 - kElsewhere) / static_cast<double>(candidates.size());
  double sum = kElsewhere;
  for (const Candidate& c : candidates) sum += each * std::exp(c.log_odds);
  for (Candidate& c : candidates) c.probability = each * std::exp(c.log_odds) / sum;
  const Candidate& best = candidates.front();
  report.probability = best.probability;
  if (best.probability >= accept_probability && best.weakest_sigma_m <= kOpenSigmaM) {
    report.outcome = SearchOutcome::kFound;
    report.T_map_body = best.T_map_body;
    report.reason = fmt::format("one of {} poses explains what is seen", candidates.size());
  } else if (best.log_odds > 0) {
    report.outcome = SearchOutcome::kAmbiguous;
    report.reason = best.probability < accept_probability
                        ? "more than one pose may explain what is seen"
                        : "the pose is not determined in every direction";
  } else {
    report.outcome = SearchOutcome::kNothing;
    report.reason = "no pose in the map explains what is seen well enough";
  }
}

}  // namespace holdfast::relocalization
