#include "holdfast/filter/initial_alignment.hpp"

#include <algorithm>
#include <array>
#include <functional>

namespace holdfast::filter {
namespace {

/// One resolution of the descent.
struct DescentStage {
  int level;
  float gate_m;
  float surface_sigma_m;  ///< how far a point may still be off its plane
  int iterations;
};

/// What is assumed of the velocity. A slow robot's scan is hardly skewed: its velocity is left to
/// the scans that follow, since freedom that the pairs cannot use only leads astray. A fast one's
/// scan must be unskewed from the first stage on.
struct Motion {
  bool rests;
  bool from_skew;
  double level_m_s;  ///< standard deviation of the horizontal velocity
  double vertical_m_s;
};
/// From planes that reach a metre to the finest, the last with the noise as it is.
constexpr std::array<DescentStage, 4> kDescent = {
    {{2, 1.2F, 0.35F, 6}, {2, 0.8F, 0.15F, 6}, {1, 0.5F, 0.05F, 5}, {0, 0.3F, 0.005F, 8}}};
constexpr std::size_t kFirstFine = 2;  // stages from here on are fine enough to tell a velocity
constexpr std::size_t kSearchPoints = 700;
constexpr std::size_t kRefined = 3;  // of each motion

struct Candidate {
  FilterState start;
  FilterState state;
  Motion motion;
  double score = 0;
};

/// The bounds of the user's pose are taken for three standard deviations of its position: the
/// pattern's places are 0.7 of the bound apart. Coarse pairs would take a table for the
/// floor, so that height and tilt (known from gravity) are held until the pairs are fine.
Matrix15d covariance(const InitialUncertainty& u, const Motion& motion, const SE3& T_map_body,
                     bool coarse) {
  const double tilt_sigma = coarse ? 0.01 : 0.05;
  const double position_sigma = u.position_m / 3.0;
  const double height_sigma = coarse ? 0.02 : position_sigma;
  Matrix15d P = Matrix15d::Zero();
  P.diagonal().segment<2>(FilterState::kP).setConstant(position_sigma * position_sigma);
  P(FilterState::kP + 2, FilterState::kP + 2) = height_sigma * height_sigma;
  // The rotation's error lives in the body frame, the vertical in the map's.
  const Eigen::Vector3d up = T_map_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  P.block<3, 3>(FilterState::kR, FilterState::kR) =
      tilt_sigma * tilt_sigma * Eigen::Matrix3d::Identity() +
      u.rotation_rad * u.rotation_rad * up * up.transpose();
  P.diagonal().segment<2>(FilterState::kV).setConstant(motion.level_m_s * motion.level_m_s);
  P(FilterState::kV + 2, FilterState::kV + 2) = motion.vertical_m_s * motion.vertical_m_s;
  P.diagonal().segment<3>(FilterState::kBa).setConstant(0.1 * 0.1);
  P.diagonal().segment<3>(FilterState::kBg).setConstant(0.02 * 0.02);
  return P;
}

/// The pose turned by the least angle that makes the mean specific force of the scan point upwards.
/// Wrong by the acceleration over g, which a robot at its start rarely has.
SE3 levelled(const SE3& T_map_body, const preprocess::ImuSegment& imu,
             const Eigen::Vector3d& gravity) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : imu.samples) force += sample.accel_m_s2;
  const Eigen::Vector3d in_map = T_map_body.rotation * force;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(in_map, -gravity);
  return {(turn * T_map_body.rotation).normalized(), T_map_body.translation};
}

/// The given pose first, then shifted in the horizontal plane and turned about the vertical; each
/// as given and levelled.
std::vector<FilterState> pattern(const FilterState& prior, const preprocess::ImuSegment& imu,
                                 const InitialUncertainty& u, const Eigen::Vector3d& gravity) {
  constexpr std::array<double, 5> kTurns = {0.0, 0.4, -0.4, 0.9, -0.9};
  constexpr std::array<std::array<double, 2>, 9> kShifts = {{{0, 0},
                                                             {0.7, 0},
                                                             {-0.7, 0},
                                                             {0, 0.7},
                                                             {0, -0.7},
                                                             {0.6, 0.6},
                                                             {-0.6, 0.6},
                                                             {0.6, -0.6},
                                                             {-0.6, -0.6}}};
  constexpr double kSameTilt = 0.02;
  std::vector<SE3> bases = {levelled(prior.T_map_body, imu, gravity)};
  if (so3::angle_between(bases[0].rotation, prior.T_map_body.rotation) > kSameTilt) {
    bases.push_back(prior.T_map_body);
  }
  std::vector<FilterState> states;
  for (const SE3& base : bases) {
    for (const double turn : kTurns) {
      for (const auto& shift : kShifts) {
        FilterState s = prior;
        const Eigen::AngleAxisd yaw(turn * u.rotation_rad, -gravity.normalized());
        s.T_map_body.rotation = (Eigen::Quaterniond(yaw) * base.rotation).normalized();
        s.T_map_body.translation += u.position_m * Eigen::Vector3d(shift[0], shift[1], 0);
        states.push_back(s);
      }
    }
  }
  return states;
}

/// What stays the same over all candidates.
struct Search {
  const map::PriorMap& map;
  const Eigen::Vector3d& gravity;
  const UpdateOptions& options;
  const InitialUncertainty& uncertainty;
  WorkerPool& pool;
  UpdateWorkspace& work;

  /// The height at which most points lie on planes, x, y and rotation being about right. The points
  /// stand deskewed in `work`.
  void choose_height(FilterState& state) const {
    constexpr int kSteps = 10;
    registration::AssociationOptions near = options.association;
    near.level = 1;
    near.gate_m = 0.2F;
    near.surface_sigma_m = 0.05F;
    near.ambiguity_sigmas = 0;
    const double low = state.T_map_body.translation.z() - uncertainty.position_m;
    double best_weight = -1;
    double best_z = state.T_map_body.translation.z();
    for (int k = 0; k <= 2 * kSteps; ++k) {
      SE3 T_anchor_body{state.T_map_body.rotation, state.T_map_body.translation - map.anchor()};
      const double z = low + uncertainty.position_m * k / kSteps;
      T_anchor_body.translation.z() = z - map.anchor().z();
      registration::associate(map, T_anchor_body, Eigen::Vector3d::Zero(), work.points, near, pool,
                              work.pairs);
      const double weight =
          registration::linearise(work.pairs, T_anchor_body, 1.0, pool, work.partials).weight;
      if (weight <= best_weight) continue;
      best_weight = weight;
      best_z = z;
    }
    state.T_map_body.translation.z() = best_z;
  }

  /// Draws the candidate into the map, stages [first, last); score = sum of robust weights at the
  /// last.
  double descend(const SelectedScan& scan, std::size_t first, std::size_t last,
                 Candidate& candidate) const {
    const Motion& motion = candidate.motion;
    double score = 0;
    for (std::size_t i = first; i < last; ++i) {
      UpdateOptions stage = options;
      stage.association.level = kDescent[i].level;
      stage.association.gate_m = kDescent[i].gate_m;
      stage.association.surface_sigma_m = kDescent[i].surface_sigma_m;
      // While the pose is off by more than the planes of an edge are apart, every point is
      // ambiguous.
      if (i + 1 < kDescent.size()) stage.association.ambiguity_sigmas = 0;
      stage.max_iterations = kDescent[i].iterations;
      stage.velocity_from_skew = motion.from_skew;
      // Each stage starts from the pose of the one before, but keeps the prior of the first: the
      // same points must not count twice.
      FilterState prior = candidate.start;
      prior.P = covariance(uncertainty, motion, prior.T_map_body, i < kFirstFine);
      const UpdateResult result =
          update_with_scan(map, scan, gravity, stage, pool, work, prior, candidate.state, nullptr);
      if (!result.usable) return 0;
      score = result.equations.weight;
    }
    return score;
  }
};

/// The given pose is likelier than one at the border of its uncertainty, by so little that it only
/// decides where the world looks the same along some direction.
double plausibility(const FilterState& state, const FilterState& prior,
                    const InitialUncertainty& uncertainty) {
  constexpr double kAtTheBorder = 0.06;
  const double off =
      (state.T_map_body.translation - prior.T_map_body.translation).norm() / uncertainty.position_m;
  return std::max(0.0, 1.0 - kAtTheBorder * off * off);
}

/// Candidates of one motion from all of the pattern, the best first.
std::vector<Candidate> ranked(const Search& search, const SelectedScan& few,
                              const FilterState& prior, const Motion& motion) {
  std::vector<Candidate> candidates;
  for (const FilterState& start : pattern(prior, few.imu, search.uncertainty, search.gravity)) {
    Candidate given{start, start, motion, 0};
    search.descend(few, 0, kFirstFine, given);
    Candidate lifted = given;
    search.choose_height(lifted.state);
    for (Candidate& candidate : {std::ref(given), std::ref(lifted)}) {
      candidate.score = search.descend(few, kFirstFine, kDescent.size(), candidate) *
                        plausibility(candidate.state, prior, search.uncertainty);
      candidates.push_back(candidate);
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return candidates;
}

/// True where the readings are those of a robot at rest, or of one that moves very evenly.
bool is_still(const preprocess::ImuSegment& imu) {
  constexpr double kRate = 0.03;  // rad/s
  constexpr double kForce = 0.3;  // m/s^2, from one reading to the others
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const ImuSample& s : imu.samples) mean += s.accel_m_s2;
  mean /= static_cast<double>(std::max<std::size_t>(imu.samples.size(), 1));
  return std::all_of(imu.samples.begin(), imu.samples.end(), [&](const ImuSample& s) {
    return s.gyro_rad_s.norm() < kRate && (s.accel_m_s2 - mean).norm() < kForce;
  });
}

/// The motions to be tried, the likeliest first.
std::vector<Motion> motions(const preprocess::ImuSegment& imu, double speed) {
  std::vector<Motion> list;
  if (is_still(imu)) list.push_back({true, false, std::min(0.05, speed), std::min(0.02, speed)});
  list.push_back({false, false, std::min(1.5, speed), std::min(0.1, speed)});
  list.push_back({false, true, speed, std::min(0.5, speed)});
  return list;
}

bool same_place(const FilterState& a, const FilterState& b) {
  return (a.T_map_body.translation - b.T_map_body.translation).norm() < 0.1 &&
         so3::angle_between(a.T_map_body.rotation, b.T_map_body.rotation) < 0.03 &&
         (a.v_map - b.v_map).norm() < 0.5;
}

/// The first `most` candidates that are not copies of a better one.
std::vector<Candidate> distinct(const std::vector<Candidate>& candidates, std::size_t most) {
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    const bool copy = std::any_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return same_place(candidate.state, other.state);
    });
    if (!copy) kept.push_back(candidate);
    if (kept.size() == most) break;
  }
  return kept;
}

}  // namespace

std::vector<StartCandidate> align_initially(const map::PriorMap& map, const SelectedScan& scan,
                                            const FilterState& prior,
                                            const InitialUncertainty& uncertainty,
                                            const Eigen::Vector3d& gravity,
                                            const UpdateOptions& options, WorkerPool& pool,
                                            UpdateWorkspace& work) {
  const Search search{map, gravity, options, uncertainty, pool, work};
  const SelectedScan few = thinned(scan, kSearchPoints);
  std::vector<StartCandidate> starts;
  for (const Motion& motion : motions(scan.imu, uncertainty.speed_m_s)) {
    StartCandidate best;
    double best_score = 0;
    for (Candidate& candidate : distinct(ranked(search, few, prior, motion), kRefined)) {
      const double share = search.descend(scan, kFirstFine, kDescent.size(), candidate) /
                           static_cast<double>(scan.selected.size());
      const double score = share * plausibility(candidate.state, prior, uncertainty);
      if (score <= best_score) continue;
      best_score = score;
      best = {candidate.state, share, motion.rests};
    }
    if (best.inlier_share > 0) starts.push_back(best);
  }
  return starts;
}

}  // namespace holdfast::filter
