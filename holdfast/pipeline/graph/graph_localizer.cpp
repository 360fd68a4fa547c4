#include "holdfast/pipeline/graph/graph_localizer.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/filter/account.hpp"
#include "holdfast/pipeline/graph/graph_states.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::pipeline {
namespace {

using estimator::Matrix18d;
using estimator::NodeState;

constexpr double kMapRadiusM = 150.0;
constexpr double kLeastWeight = 30.0;
constexpr double kCoarseFromM = 0.1;
constexpr float kCoarseSurfaceSigmaM = 0.05F;
constexpr double kLeverM = 10.0;           // how far the map's planes are away
constexpr int kJumpAges = 4;               // intervals in which a bias may have jumped unnoticed
constexpr double kSkewToldM = 0.005;       // skew that is worth being estimated
constexpr double kMostlyMapped = 0.5;      // share of returns; below, an odometry sees more
constexpr double kHardlyMapped = 0.2;      // below, this is outside of the map
constexpr double kFewToldInflation = 2.0;  // of the variance (docs/decisions/0004)
constexpr double kMostScansAlike = 30;     // of the same part of the map, however slow the robot

}  // namespace

GraphLocalizer::GraphLocalizer(map::PriorMap map, const Setup& setup, const SE3& T_map_body)
    : GraphLocalizer(std::move(map), setup) {
  start_ = std::make_unique<baselines::MapFilter>(std::move(*map_), setup.start, T_map_body);
  map_.reset();
  placed_ = true;
}

GraphLocalizer::GraphLocalizer(map::PriorMap map, const Setup& setup)
    : setup_(setup),
      map_(std::make_unique<map::PriorMap>(std::move(map))),
      placed_(false),
      pool_(setup.start.threads),
      smoother_(setup.smoother) {
  scan_.T_body_lidar = setup.start.T_body_lidar;
  if (setup.graph.odometry == "on") witness_ = std::make_unique<OdometryWitness>(setup.odometry);
  if (setup.monitor) health_.emplace(*setup.monitor, setup.places);
}

void GraphLocalizer::add_imu(const ImuSample& sample) {
  imu_.add(sample);
  if (witness_) witness_->add_imu(sample);
  if (start_) start_->add_imu(sample);
}

StepReport GraphLocalizer::add_scan(const Scan& scan) {
  if (start_) return start(scan);
  StepReport report;
  report.stamp = scan.stamp;
  report.pose_time = scan.end_time;
  {
    StageClock clock(report.times);
    if (witness_) witness_->add_scan(scan);
    clock.book(Stage::kOdometry);
    placed_ ? step(scan, clock, report) : wait(report);
    clock.book(Stage::kHealth);
  }
  if (witness_) report.odom_epoch = witness_->epoch();
  ++scan_number_;
  return report;
}

filter::UpdateOptions GraphLocalizer::options() const {
  const auto& f = setup_.start.filter;
  filter::UpdateOptions o;
  o.association.gate_m = static_cast<float>(f.gate_m);
  o.association.range_sigma_m = static_cast<float>(setup_.start.range_sigma_m);
  o.association.surface_sigma_m = static_cast<float>(f.surface_sigma_m);
  o.robust_scale = f.robust_scale;
  // The map's own error over the extent of a scan is the same for all scans of one place: each of
  // them may count only for its share of them.
  const double alike = std::clamp(
      setup_.graph.map_correlation_m / std::max(travel_per_scan_m_, 1e-9), 1.0, kMostScansAlike);
  o.map_sigma_m = setup_.graph.map_error_share * map_->info().noise_m * std::sqrt(alike);
  o.map_sigma_rad = o.map_sigma_m / kLeverM;
  return o;
}

void GraphLocalizer::step(const Scan& scan, StageClock& clock, StepReport& report) {
  if (!prepare(scan, report)) return;
  clock.book(Stage::kSelect);
  const NodeState before = smoother_.newest();
  if (!predict(scan.end_time, report)) return;
  const NodeState predicted = smoother_.newest();
  report.T_map_predicted = predicted.T_map_body;
  clock.book(Stage::kPredict);
  Match found = match(predicted, clock);
  allow_for_bias_jump(found, clock);
  carry_on_by_odometry(found);
  clock.book(Stage::kSolve);
  travel_per_scan_m_ =
      (smoother_.newest().T_map_body.translation - before.T_map_body.translation).norm();
  if (found.usable) demand_.learn(found.equations, scan_.selected.size(), setup_.start.selection);
  estimate_map_error(found);
  describe(found, report);
  judge(found, report);
  ask_monitor(*map_, work_.points, report);
  imu_.drop_before(scan.end_time - kImuMemory);
}

/// Selects the points, readings and tiles that the scan needs.
bool GraphLocalizer::prepare(const Scan& scan, StepReport& report) {
  const NodeState& last = smoother_.newest();
  report.T_map_body = last.T_map_body;
  if (scan.end_time <= last.t) {
    report.state = State::kDeadReckoning;
    report.reason = "scan is not later than the one before";
    return false;
  }
  scan_.scan = &scan;
  preprocess::select_points(scan, demand_.next(setup_.start.selection), scan_number_,
                            scan_.selected);
  imu_.segment(scan.stamp, scan.end_time, scan_.imu);
  if (const auto focused = map_->focus(last.T_map_body.translation, kMapRadiusM); !focused) {
    report.state = State::kLost;
    report.reason = focused.error().message;
    return false;
  }
  return true;
}

bool GraphLocalizer::predict(TimeNs to, StepReport& report) {
  if (!imu_.segment(smoother_.newest().t, to, segment_)) return false;
  report.imu_held_ns = segment_.held_ns;
  allow_for_silence();
  motion_ = witness_ ? witness_->take_motion() : std::nullopt;
  const bool sees_more = last_mapped_share_ < kMostlyMapped;
  smoother_.push(segment_, sees_more ? motion_ : std::nullopt);
  return true;
}

/// While the IMU is silent the biases stand for what the robot does; they are biases again for
/// readings that were measured. Between two readings far apart neither tells what it does: the
/// biases of before are the best start, and let go likewise.
void GraphLocalizer::allow_for_silence() {
  const bool between = segment_.longest_gap_ns > filter::kLongestHold && segment_.held_ns == 0;
  if (between) segment_.held_ns = segment_.longest_gap_ns;
  silent_ = segment_.held_ns > filter::kLongestHold;
  if (silent_ && !before_hold_)
    before_hold_ = ImuState{smoother_.newest(), smoother_.covariance_of_newest()};
  if (!before_hold_ || (silent_ && !between)) return;
  restore_biases();
  if (!silent_) before_hold_.reset();
}

/// Biases and gravity, which are known together, independently of the rest of the newest node.
void GraphLocalizer::restore_biases() {
  constexpr int kMoving = NodeState::kBa;
  constexpr int kSteady = NodeState::kSize - kMoving;
  NodeState x = smoother_.newest();
  x.accel_bias = before_hold_->x.accel_bias;
  x.gyro_bias = before_hold_->x.gyro_bias;
  Matrix18d P = smoother_.covariance_of_newest();
  P.topRightCorner<kMoving, kSteady>().setZero();
  P.bottomLeftCorner<kSteady, kMoving>().setZero();
  P.bottomRightCorner<kSteady, kSteady>() = before_hold_->P.bottomRightCorner<kSteady, kSteady>();
  if (silent_) {
    const auto& motion = setup_.smoother.noise.unmeasured;
    P.diagonal().segment<3>(NodeState::kBa).array() += std::pow(motion.accel_sigma_m_s2, 2);
    P.diagonal().segment<3>(NodeState::kBg).array() += std::pow(motion.gyro_sigma_rad_s, 2);
  }
  smoother_.reset(x, P);
}

GraphLocalizer::Match GraphLocalizer::match(const NodeState& predicted, StageClock& clock) {
  Match found;
  if (scan_.selected.empty()) {
    work_.points.resize(0);
  } else {
    found = match_finely(options(), clock);
    const double sigma = filter::largest_sigma(smoother_.covariance_of_prediction(), NodeState::kP);
    if (sigma > kCoarseFromM) {
      const NodeState direct = smoother_.newest();
      if (lead_by_coarse_planes(predicted, sigma, clock)) {
        const Match led = match_finely(options(), clock);
        if (led.equations.weight > found.equations.weight) {
          found = led;
        } else {
          smoother_.set_guess(direct);
          found = match_finely(options(), clock);
        }
      }
    }
  }
  const double share =
      found.equations.weight / std::max<double>(1.0, static_cast<double>(scan_.selected.size()));
  found.usable = found.optimised.solved && found.equations.weight >= kLeastWeight &&
                 share >= setup_.start.filter.min_inlier_share;
  if (!found.usable) {
    smoother_.set_guess(predicted);
    smoother_.optimise([](const NodeState&) { return std::nullopt; });
  }
  return found;
}

/// IMU, odometry and map together; the map residual is linearised anew in every iteration.
GraphLocalizer::Match GraphLocalizer::match_finely(const filter::UpdateOptions& options,
                                                   StageClock& clock) {
  const filter::PairingWith<map::PriorMap> pairing(*map_);
  filter::ScanMatch scan(pairing, scan_, options, pool_, work_, &clock);
  estimator::OptimiseOptions how;
  how.min_measurements = filter::ScanMatch::kCalls;
  how.max_measurements = options.max_iterations;
  Match found;
  found.optimised = smoother_.optimise(
      [&](const NodeState& x) -> std::optional<estimator::MapFactor> {
        const filter::ScanEquations e = scan.linearise(match_state_of(x), motion_is_open());
        found.equations = scan.raw();
        if (found.equations.weight < kLeastWeight) return std::nullopt;
        return estimator::MapFactor(e.H, e.g, scan.raw().cost, x);
      },
      how);
  return found;
}

/// Is the motion during the scan so uncertain that its skew has to tell it?
bool GraphLocalizer::motion_is_open() const {
  const double span = to_seconds(scan_.scan->end_time - scan_.scan->stamp);
  const Matrix18d P = smoother_.covariance_of_prediction();
  return span * filter::largest_sigma(P, NodeState::kV) > kSkewToldM ||
         span * filter::largest_sigma(P, NodeState::kBg) * kLeverM > kSkewToldM;
}

/// Where the prediction may be off by more than the finest planes reach, coarser ones give a guess.
bool GraphLocalizer::lead_by_coarse_planes(const NodeState& predicted, double sigma_m,
                                           StageClock& clock) {
  const filter::FilterState prior =
      filter_state_of(predicted, smoother_.covariance_of_prediction());
  filter::FilterState state = prior;
  for (int level = sigma_m > 3.0 * kCoarseFromM ? 2 : 1; level > 0; --level) {
    filter::UpdateOptions how = options();
    how.association.level = level;
    how.association.gate_m = std::max(how.association.gate_m, static_cast<float>(3.0 * sigma_m));
    how.association.surface_sigma_m = kCoarseSurfaceSigmaM;
    how.association.ambiguity_sigmas = 0;
    how.velocity_from_skew = motion_is_open();
    const auto update = filter::update_with_scan(*map_, scan_, predicted.gravity_map, how, pool_,
                                                 work_, prior, state, &clock);
    if (!update.usable) return false;
  }
  smoother_.set_guess(node_of(state, predicted.gravity_map));
  return true;
}

/// A scan that contradicts the IMU is explained by a jump of its biases if that explains it better.
void GraphLocalizer::allow_for_bias_jump(Match& match, StageClock& clock) {
  if (!match.usable || smoother_.innovation(match.optimised) < setup_.graph.surprise) return;
  int best_age = -1;
  double best_gain = setup_.graph.surprise;
  for (int age = 0; age < kJumpAges; ++age) {
    const double gain = smoother_.bias_jump_gain(age);
    if (gain <= best_gain) continue;
    best_gain = gain;
    best_age = age;
  }
  if (best_age < 0) return;
  smoother_.allow_bias_jump(best_age);
  match = match_finely(options(), clock);
  match.usable = match.optimised.solved && match.equations.weight >= kLeastWeight;
}

/// Where the map tells nothing, or has little of what is there, the odometry carries the pose on.
/// Elsewhere it is left out: it saw the same points as the map match, so that both together would
/// claim more than they know.
void GraphLocalizer::carry_on_by_odometry(Match& match) {
  if (!witness_ || scan_.selected.empty()) return;
  const double pairs = match.equations.pairs / static_cast<double>(scan_.selected.size());
  if (pairs < kMostlyMapped) match.mapped_share = mapped_share(smoother_.newest().T_map_body);
  const bool linked = last_mapped_share_ < kMostlyMapped;
  last_mapped_share_ = match.mapped_share;
  witness_->set_alone(last_mapped_share_ < kMostlyMapped);
  if (match.usable || linked || !motion_) return;
  smoother_.link_newest(*motion_);
  smoother_.optimise([](const NodeState&) { return std::nullopt; });
}

/// Share of the returns around which the map has anything at all.
double GraphLocalizer::mapped_share(const SE3& T_map_body) const {
  constexpr std::size_t kEvery = 8;
  const Eigen::Matrix3f R = T_map_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f p = (T_map_body.translation - map_->anchor()).cast<float>();
  int mapped = 0;
  int asked = 0;
  for (std::size_t i = 0; i < work_.points.size(); i += kEvery, ++asked) {
    const auto hit = map_->find(map::kLevels - 1, R * work_.points.points[i] + p);
    mapped += hit.surface != nullptr ? 1 : 0;
  }
  return asked > 0 ? static_cast<double>(mapped) / asked : 1.0;
}

/// The map's own error is the same for all scans of a place. It does not average out as their noise
/// does, so that it stands beside what the graph knows given the map.
void GraphLocalizer::estimate_map_error(const Match& match) {
  if (!match.usable) return;
  const filter::UpdateOptions o = options();
  const filter::PatchModel model{setup_.graph.patch_error_share, map_->info().noise_m,
                                 o.association.range_sigma_m, o.association.surface_sigma_m,
                                 scan_.T_body_lidar.translation.cast<float>()};
  const SE3& T = smoother_.newest().T_map_body;
  map_error_ = patches_.of(work_.pairs, {T.rotation, T.translation - map_->anchor()},
                           o.robust_scale, match.equations.H.topLeftCorner<6, 6>(), model);
  few_told_ = registration::few_told_directions(match.equations);
}

/// Of the newest pose, in the order of StepReport::pose_covariance. Where few surfaces tell a
/// direction, one scan after the other sees the same ones, and errs as they do.
filter::Matrix6d GraphLocalizer::pose_covariance() const {
  filter::Matrix6d P = smoother_.covariance_of_newest().topLeftCorner<6, 6>() + map_error_;
  for (const Eigen::Vector3d& u : few_told_) {
    const double variance = u.dot(P.topLeftCorner<3, 3>() * u);
    P.topLeftCorner<3, 3>() += (kFewToldInflation - 1.0) * variance * u * u.transpose();
  }
  return P;
}

void GraphLocalizer::describe(const Match& match, StepReport& report) const {
  report.T_map_body = smoother_.newest().T_map_body;
  filter::report_match(match.equations, scan_.selected.size(), report);
  filter::report_covariance(pose_covariance(), report);
  if (match.usable) {
    report.weak_directions =
        registration::weak_directions(match.equations, setup_.start.filter.weak_sigma_m);
  }
}

void GraphLocalizer::judge(const Match& match, StepReport& report) {
  if (witness_ && match.usable) witness_->compare({report.T_map_body, report.pose_covariance});
  if (report.sigma_trans_m > setup_.start.filter.lost_sigma_m) {
    report.state = State::kLost;
    report.reason = "too long without a scan that fits the map";
  } else if (!match.usable && match.mapped_share < kHardlyMapped) {
    report.state = State::kUnmapped;
    report.reason = "the map has nothing of what is around; the odometry carries the pose on";
  } else if (!match.usable) {
    report.state = State::kDeadReckoning;
    report.reason = scan_.selected.empty() ? "no returns" : "the scan does not fit the map";
  } else if (!report.weak_directions.empty()) {
    report.state = State::kDegraded;
    report.reason = "the scene does not determine every direction";
  } else {
    report.state = State::kTracking;
  }
}

void GraphLocalizer::ask_monitor(const map::PriorMap& map, const registration::BodyPoints& points,
                                 StepReport& report) {
  if (!health_) return;
  SceneView scene{map, points, scan_.T_body_lidar.translation};
  if (witness_) scene.odometry = {witness_->broke(), witness_->way_squared_distance()};
  health_->judge(scene, report);
}

}  // namespace holdfast::pipeline
