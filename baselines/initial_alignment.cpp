#include "baselines/initial_alignment.hpp"

#include <algorithm>
#include <numbers>

namespace holdfast::baselines {
namespace {

/// One resolution of the descent.
struct DescentStage {
  int level;
  float gate_m;
  float surface_sigma_m;  ///< how far a point may still be off its plane
  int iterations;
};

/// From planes that reach a metre to the finest, the last with the noise as it is.
constexpr std::array<DescentStage, 4> kDescent = {{{2, 1.2F, 0.35F, 6},
                                                   {2, 0.8F, 0.15F, 6},
                                                   {1, 0.5F, 0.05F, 5},
                                                   {0, 0.3F, 0.02F, 5}}};
constexpr std::size_t kSearchPoints = 700;
constexpr std::size_t kRefined = 4;

struct Candidate {
  FilterState state;
  double score = 0;
  int number = 0;  ///< in the pattern: breaks ties
};

Matrix15d wide_covariance(const InitialUncertainty& u) {
  Matrix15d P = Matrix15d::Zero();
  const auto set = [&P](int offset, double sigma) {
    P.diagonal().segment<3>(offset).setConstant(sigma * sigma);
  };
  set(FilterState::kP, u.position_m);
  set(FilterState::kR, u.rotation_rad);
  set(FilterState::kV, u.speed_m_s);
  set(FilterState::kBa, 0.1);
  set(FilterState::kBg, 0.02);
  return P;
}

/// The given pose first, then shifted in the horizontal plane and turned about the vertical.
std::vector<FilterState> pattern(const FilterState& prior, const InitialUncertainty& u,
                                 const Eigen::Vector3d& gravity) {
  constexpr std::array<double, 5> kTurns = {0.0, 0.4, -0.4, 0.9, -0.9};
  constexpr std::array<std::array<double, 2>, 9> kShifts = {
      {{0, 0}, {0.7, 0}, {-0.7, 0}, {0, 0.7}, {0, -0.7}, {0.6, 0.6}, {-0.6, 0.6}, {0.6, -0.6},
       {-0.6, -0.6}}};
  const Eigen::Vector3d up = -gravity.normalized();
  std::vector<FilterState> states;
  for (const double turn : kTurns) {
    for (const auto& shift : kShifts) {
      FilterState s = prior;
      const Eigen::AngleAxisd yaw(turn * u.rotation_rad, up);
      s.T_map_body.rotation = (Eigen::Quaterniond(yaw) * s.T_map_body.rotation).normalized();
      s.T_map_body.translation += u.position_m * Eigen::Vector3d(shift[0], shift[1], 0);
      states.push_back(s);
    }
  }
  return states;
}

SelectedScan thinned(const SelectedScan& scan, std::size_t most) {
  SelectedScan few = scan;
  if (few.selected.size() <= most) return few;
  for (std::size_t k = 0; k < most; ++k) {
    // An odd stride over the beams: neighbours in the list are neighbours on the sensor.
    const std::size_t begin = k * scan.selected.size() / most;
    const std::size_t end = (k + 1) * scan.selected.size() / most;
    few.selected[k] = scan.selected[begin + (k * 7) % (end - begin)];
  }
  few.selected.resize(most);
  return few;
}

/// What stays the same over all candidates.
struct Search {
  const map::PriorMap& map;
  const Eigen::Vector3d& gravity;
  const UpdateOptions& options;
  const InitialUncertainty& uncertainty;
  WorkerPool& pool;
  UpdateWorkspace& work;

  /// Draws `state` into the map, stages [first, end); score = sum of robust weights at the last.
  double descend(const SelectedScan& scan, std::size_t first, FilterState& state) const {
    double score = 0;
    for (std::size_t i = first; i < kDescent.size(); ++i) {
      UpdateOptions stage = options;
      stage.association.level = kDescent[i].level;
      stage.association.gate_m = kDescent[i].gate_m;
      stage.association.surface_sigma_m = kDescent[i].surface_sigma_m;
      stage.max_iterations = kDescent[i].iterations;
      // Each stage starts from the pose of the one before, not from its covariance: the same points
      // must not count twice.
      state.P = wide_covariance(uncertainty);
      const UpdateResult result =
          update_with_scan(map, scan, gravity, stage, pool, work, state, nullptr);
      if (!result.usable) return 0;
      score = result.equations.weight;
    }
    return score;
  }
};

std::vector<Candidate> ranked(const Search& search, const SelectedScan& few,
                              const FilterState& prior) {
  std::vector<Candidate> candidates;
  int number = 0;
  for (FilterState& state : pattern(prior, search.uncertainty, search.gravity)) {
    Candidate candidate{state, 0, number++};
    candidate.score = search.descend(few, 0, candidate.state);
    candidates.push_back(candidate);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  return candidates;
}

}  // namespace

InitialAlignment align_initially(const map::PriorMap& map, const SelectedScan& scan,
                                 const FilterState& prior, const InitialUncertainty& uncertainty,
                                 const Eigen::Vector3d& gravity, const UpdateOptions& options,
                                 WorkerPool& pool, UpdateWorkspace& work) {
  const Search search{map, gravity, options, uncertainty, pool, work};
  const std::vector<Candidate> candidates = ranked(search, thinned(scan, kSearchPoints), prior);
  InitialAlignment best;
  double best_score = 0;
  for (std::size_t i = 0; i < std::min(kRefined, candidates.size()); ++i) {
    FilterState state = candidates[i].state;
    if (search.descend(scan, 2, state) <= 0) continue;
    // Last with the noise as it is, for a covariance that can be believed.
    state.P = wide_covariance(uncertainty);
    const UpdateResult result =
        update_with_scan(map, scan, gravity, options, pool, work, state, nullptr);
    if (!result.usable || result.equations.weight <= best_score) continue;
    best_score = result.equations.weight;
    best.state = state;
    best.inlier_share = best_score / static_cast<double>(scan.selected.size());
    best.found = true;
  }
  return best;
}

}  // namespace holdfast::baselines
