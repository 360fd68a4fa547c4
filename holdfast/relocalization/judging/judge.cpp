#include "holdfast/relocalization/judging/judge.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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
constexpr double kOpenSigmaM = 0.2;  // a direction known worse than that is not determined
constexpr double kElsewhere = 0.05;  // probability of none of the candidates, before looking

// What tells poses apart.
constexpr float kOddsOfASurface = 80;  // residuals of 2 cm against returns from within a metre
constexpr float kSurfaceSigmaM = 0.004F;
constexpr float kFewestInASector = 8;     // points
constexpr double kNatsOfALook = 2.2;      // ln 9: one in ten things is not where it was
constexpr double kClearDifference = 0.3;  // of what is explained in a sector: it is another thing

monitor::UsualLooks usual_at(const places::Place& place) {
  const double through = static_cast<double>(place.through_share);
  return {std::min(1.0, static_cast<double>(place.agreeing_share) / monitor::kUsualFitting),
          through, static_cast<double>(place.unmapped_share) / std::max(1e-3, 1.0 - through),
          kPlaceWorth};
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

std::size_t sector_of(const Eigen::Vector3f& p) {
  const float turn = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi_v<float>)+0.5F;
  return std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors));
}

/// What the points say for the pose, as a share of what they could say at most, each with a
/// residual of zero: there a return from the surface is kOddsOfASurface times as likely as one from
/// anywhere.
void explain(const map::PriorMap& map, const Sight& sight, const SE3& T_anchor_body,
             Candidate& candidate) {
  registration::AssociationOptions how;
  how.range_sigma_m = static_cast<float>(sight.range_sigma_m);
  how.surface_sigma_m = kSurfaceSigmaM;
  how.ambiguity_sigmas = 0;  // either plane explains the point
  WorkerPool alone;
  registration::Correspondences pairs;
  registration::associate(map, T_anchor_body, sight.p_body_lidar, sight.points, how, alone, pairs);
  const Eigen::Matrix3f R = T_anchor_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = T_anchor_body.translation.cast<float>();
  const float most = std::log1p(kOddsOfASurface);
  std::array<float, kSectors> sums{}, counts{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3f n(pairs.nx[i], pairs.ny[i], pairs.nz[i]);
    const Eigen::Vector3f& q = sight.points.points[i];
    const float r = n.dot(R * q + t) - pairs.offset[i];
    const std::size_t sector = sector_of(q - sight.p_body_lidar.cast<float>());
    counts[sector] += 1;
    if (pairs.information[i] <= 0) continue;
    sums[sector] +=
        std::log1p(kOddsOfASurface * std::exp(-0.5F * r * r * pairs.information[i])) / most;
  }
  float sum = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    sum += sums[s];
    candidate.by_sector[s] = counts[s] < kFewestInASector ? -1.0F : sums[s] / counts[s];
  }
  candidate.explained = sum / static_cast<float>(std::max<std::size_t>(1, pairs.size()));
}

/// ln of how much likelier `a` is than `b`, by what tells them apart: each sector is one look, and
/// what it shows may have been changed.
double log_ratio(const Candidate& a, const Candidate& b) {
  double sum = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    if (a.by_sector[s] < 0) continue;
    const double more = static_cast<double>(a.by_sector[s] - b.by_sector[s]);
    sum += std::clamp(kNatsOfALook * more / kClearDifference, -kNatsOfALook, kNatsOfALook);
  }
  return sum;
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
  const double right = 0.6 + 0.25 * std::exp(of(Hypothesis::kChanged) - scale) +
                       0.15 * std::exp(of(Hypothesis::kCrowded) - scale);
  const double wrong = 0.9 * std::exp(of(Hypothesis::kWrongStrange) - scale) +
                       0.1 * std::exp(of(Hypothesis::kWrongAlike) - scale);
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
  explain(map, sight, T_anchor_body, c);
  c.log_odds = log_odds(c.seen, c.usual);
  const Eigen::Matrix3d feigned =
      registration::feigned_information(e, refined.pairs, T_anchor_body, kRobustScale, kFewPairs);
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
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.explained > b.explained; });
  if (candidates.empty()) {
    report.outcome = SearchOutcome::kNothing;
    report.reason = "no pose in the map explains what is seen";
    return;
  }
  const Candidate& best = candidates.front();
  const double elsewhere = kElsewhere / (1.0 - kElsewhere) * std::exp(-best.log_odds);
  double sum = elsewhere;
  for (Candidate& c : candidates) sum += c.probability = std::exp(-log_ratio(best, c));
  for (Candidate& c : candidates) c.probability /= sum;
  report.probability = best.probability;
  if (best.weakest_sigma_m > kOpenSigmaM) {
    report.outcome = SearchOutcome::kAmbiguous;
    report.reason = "the pose is not determined in every direction";
  } else if (best.probability >= accept_probability) {
    report.outcome = SearchOutcome::kFound;
    report.T_map_body = best.T_map_body;
    report.reason = fmt::format("of {} poses one explains what is seen", candidates.size());
  } else if (elsewhere > 1.0) {
    report.outcome = SearchOutcome::kNothing;
    report.reason = "no pose in the map explains what is seen well enough";
  } else {
    report.outcome = SearchOutcome::kAmbiguous;
    report.reason = "more than one pose may explain what is seen";
  }
}

}  // namespace holdfast::relocalization
