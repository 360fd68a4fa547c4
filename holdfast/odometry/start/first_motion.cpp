#include "holdfast/odometry/start/first_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace holdfast::odometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using filter::FilterState;

constexpr double kStepM = 0.3;
constexpr double kSearchSigmaM = 0.2;
constexpr double kFirstMapSigmaM = 0.005;  // error of a map of one scan, common to its points
constexpr double kRestSigmaM = 0.003;
constexpr double kTurnSigma = 0.003;   // rad, of the gyroscope over a scan
constexpr double kClimbSigmaM = 0.03;  // likewise upwards: robots hardly climb
constexpr double kFelt = 30.0;         // squared sigmas from which a way is none of the noise
constexpr std::size_t kSearchPoints = 1000;
constexpr std::size_t kRoughPoints = 200;
constexpr double kRoughScale = 8.0;    // robust scale of what is off by half a step
constexpr std::size_t kRoughWays = 4;  // by planes that are looked at closely
constexpr std::size_t kVotedWays = 3;  // by edges
constexpr double kSameWayM = 0.1;      // where a way leads to another
constexpr double kBetter = 40.0;       // squared sigmas by which a faster motion must explain more
constexpr double kNothing = 1e12;      // cost of what cannot be matched
constexpr double kLeastShare = 0.1;    // of the points that must agree
constexpr int kRefinements = 2;        // with scans that are moved by what was found
constexpr double kHardBraking = 3.0;   // m/s^2

void set_sigma(FilterState& state, int offset, double sigma) {
  state.P.diagonal().segment<3>(offset).setConstant(sigma * sigma);
}

filter::MatchState match_state(const FilterState& s, const Vector3d& gravity) {
  return {s.T_map_body, s.v_map, s.accel_bias, s.gyro_bias, gravity};
}

/// A way and what speaks against it, in squared sigmas.
struct Explanation {
  Vector3d way = Vector3d::Zero();
  Matrix3d P = Matrix3d::Zero();
  double cost = kNothing;
};

/// The second scan, held against the first for one way after the other.
class Search {
 public:
  /// `turned`: at the second scan, but for the way.
  Search(const FirstScan& first, const filter::SelectedScan& second, const FilterState& turned,
         const std::vector<SeenEdge>& edges, const Vector3d& gravity, const SearchTools& tools)
      : first_(first),
        turned_(turned),
        gravity_(gravity),
        tools_(tools),
        options_(tools.options),
        few_(filter::thinned(second, kSearchPoints)),
        fewest_(filter::thinned(second, kRoughPoints)),
        edges_(put_edges(first.edges, first.selected, match_state(first.state, gravity)),
               put_edges(edges, second, match_state(turned, gravity))) {
    options_.max_iterations = 5;
    options_.map_sigma_m = kFirstMapSigmaM;
  }

  /// What is worth being looked at closely, shortest first; before all rest, if it may be, and the
  /// guess.
  std::vector<Vector3d> candidates(const Vector3d& guess, double longest_m) const {
    std::vector<Vector3d> all = rough_ways(longest_m);
    const auto voted = edges_.votes(longest_m, kVotedWays);
    all.insert(all.end(), voted.begin(), voted.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
    if (guess.norm() > 0) all.insert(all.begin(), guess);
    if (first_.may_rest) all.insert(all.begin(), Vector3d::Zero());
    return all;
  }

  /// The best way near `start`, by planes and edges together.
  Explanation explain(const Vector3d& start, double sigma_m) const {
    const FilterState prior = displaced(start, sigma_m);
    FilterState state = prior;
    const auto result = filter::update_with_scan(tools_.pairing, few_, gravity_, options_,
                                                 tools_.pool, tools_.work, prior, state, nullptr);
    const auto n = static_cast<double>(few_.selected.size());
    if (!result.usable || result.equations.weight < kLeastShare * n) return {};
    // Points without a pair cost as much as those that are far off.
    const double most = options_.robust_scale * options_.robust_scale;
    Explanation found;
    found.way = state.T_map_body.translation - first_.state.T_map_body.translation;
    found.P = state.P.topLeftCorner<3, 3>();
    found.cost = result.equations.cost + most * (n - result.equations.pairs);
    add_edges(found);
    return found;
  }

 private:
  /// Where the second scan ends, displaced by `way`.
  FilterState displaced(const Vector3d& way, double sigma_m) const {
    FilterState state = turned_;
    state.T_map_body.translation += way;
    state.P.setZero();
    set_sigma(state, FilterState::kP, sigma_m);
    const double climb_m = std::min(sigma_m, kClimbSigmaM);
    state.P(FilterState::kP + 2, FilterState::kP + 2) = climb_m * climb_m;
    set_sigma(state, FilterState::kR, kTurnSigma);
    set_sigma(state, FilterState::kV, 1e-3);
    set_sigma(state, FilterState::kBa, 1e-3);
    set_sigma(state, FilterState::kBg, 1e-4);
    return state;
  }

  /// Joins what the edges say to what the planes said.
  void add_edges(Explanation& found) const {
    const Matrix3d of_planes = found.P.inverse();
    const EdgeWays::Told told = edges_.refine(found.way, found.P);
    const Vector3d& moved = told.moved;
    found.way += moved;
    found.P = (of_planes + told.information).inverse();
    found.cost += moved.dot(of_planes * moved) + edges_.fit(found.way).cost;
  }

  /// Ways of a pattern at which the planes of the second scan meet those of the first best.
  std::vector<Vector3d> rough_ways(double longest_m) const {
    filter::deskew_scan(
        fewest_,
        {turned_.T_map_body, Vector3d::Zero(), turned_.accel_bias, turned_.gyro_bias, gravity_},
        tools_.work);
    std::vector<Explanation> all;
    const int steps = static_cast<int>(std::ceil(longest_m / kStepM));
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        const Vector3d way(kStepM * i, kStepM * j, 0);
        if (way.norm() > longest_m + 0.5 * kStepM) continue;
        all.push_back({way, Matrix3d::Zero(), rough_cost(way)});
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.cost < b.cost; });
    std::vector<Vector3d> best;
    for (const Explanation& e : all) {
      const bool is_new = std::none_of(best.begin(), best.end(), [&](const Vector3d& way) {
        return (way - e.way).norm() < 1.5 * kStepM;
      });
      if (is_new) best.push_back(e.way);
      if (best.size() == kRoughWays) break;
    }
    return best;
  }

  double rough_cost(const Vector3d& way) const {
    auto& work = tools_.work;
    SE3 T = turned_.T_map_body;
    T.translation += way - tools_.pairing.anchor();
    tools_.pairing.associate(T, few_.T_body_lidar.translation, work.points, options_.association,
                             tools_.pool, work.pairs);
    const auto fit =
        registration::linearise(work.pairs, T, kRoughScale, tools_.pool, work.partials);
    const auto n = static_cast<double>(work.points.size());
    return fit.cost + kRoughScale * kRoughScale * (n - fit.pairs);
  }

  const FirstScan& first_;
  const FilterState& turned_;
  const Vector3d& gravity_;
  const SearchTools& tools_;
  filter::UpdateOptions options_;
  filter::SelectedScan few_, fewest_;
  EdgeWays edges_;
};

bool is_among(const std::vector<Vector3d>& ways, const Vector3d& way) {
  return std::any_of(ways.begin(), ways.end(),
                     [&](const Vector3d& known) { return (known - way).norm() < kSameWayM; });
}

/// Where floor and ceiling are hardly seen, the height that fits best is noise.
Vector3d level(const Vector3d& way) { return {way.x(), way.y(), 0}; }

bool is_felt(const Vector3d& way, const Matrix3d& P) {
  return way.dot(P.ldlt().solve(way)) > kFelt;
}

/// The shortest way that no other explains better.
Explanation best_of_all(const Search& search, const Vector3d& guess, double longest_m,
                        bool may_rest, FirstMotion& motion) {
  const double resting = search.explain(Vector3d::Zero(), kRestSigmaM).cost;
  Explanation best;
  std::vector<Vector3d> known;
  for (const Vector3d& start : search.candidates(guess, longest_m)) {
    if (is_among(known, start)) continue;
    Explanation found = search.explain(start, kSearchSigmaM);
    known.push_back(found.way);
    if (found.cost >= kNothing || found.cost > best.cost - kBetter) continue;
    const bool moves = !may_rest || (is_felt(found.way, found.P) && found.cost < resting);
    motion = moves ? FirstMotion::kMoves : FirstMotion::kRests;
    if (!moves) found.way.setZero();
    best = found;
  }
  return best;
}

/// At `to`, if the body only turned since `from`, as the gyroscope says, and stands still, so that
/// both scans stay as skewed as they are.
FilterState turned_on_the_spot(const FilterState& from, const preprocess::ImuSegment& imu,
                               TimeNs to) {
  Vector3d rate = Vector3d::Zero();
  for (const ImuSample& s : imu.samples) rate += s.gyro_rad_s - from.gyro_bias;
  rate /= static_cast<double>(std::max<std::size_t>(imu.samples.size(), 1));
  FilterState turned = from;
  turned.t = to;
  turned.v_map.setZero();
  turned.T_map_body.rotation =
      (from.T_map_body.rotation * so3::exp(to_seconds(to - from.t) * rate)).normalized();
  return turned;
}

}  // namespace

void begin_map(const FirstScan& first, const Vector3d& v_odom, const Vector3d& gravity,
               LocalMap& map, filter::UpdateWorkspace& work) {
  filter::MatchState moving = match_state(first.state, gravity);
  moving.v_map = v_odom;
  filter::deskew_scan(first.selected, moving, work);
  map.clear();
  map.follow(moving.T_map_body.translation);
  map.insert(work.points.points, moving.T_map_body, first.selected.T_body_lidar.translation);
}

FirstMotion find_first_motion(FirstScan& first, const filter::SelectedScan& second,
                              TimeNs second_end, const std::vector<SeenEdge>& edges,
                              double longest_m, const Vector3d& gravity, SearchTools tools) {
  const double dt = to_seconds(second_end - first.state.t);
  const Vector3d guess = dt * first.state.v_map;
  first.state.v_map.setZero();
  FilterState turned = turned_on_the_spot(first.state, second.imu, second_end);
  FirstMotion motion = FirstMotion::kNone;
  Explanation best = best_of_all(Search(first, second, turned, edges, gravity, tools), guess,
                                 longest_m, first.may_rest, motion);
  for (int i = 0; i < kRefinements && motion == FirstMotion::kMoves; ++i) {
    first.state.v_map = turned.v_map = level(best.way) / dt;
    begin_map(first, first.state.v_map, gravity, tools.map, tools.work);
    const Explanation finer =
        Search(first, second, turned, edges, gravity, tools).explain(best.way, kSearchSigmaM);
    if (finer.cost < kNothing) best = finer;
  }
  first.state.v_map = level(best.way) / dt;
  first.state.P.block<3, 3>(FilterState::kV, FilterState::kV) =
      best.P / (dt * dt) + std::pow(kHardBraking * dt, 2) * Matrix3d::Identity();
  return motion;
}

}  // namespace holdfast::odometry
