#include <cmath>

#include "holdfast/pipeline/graph/graph_localizer.hpp"
#include "holdfast/pipeline/graph/graph_states.hpp"

/// The graph until it has a pose, and when it is given one.
namespace holdfast::pipeline {
namespace {

using estimator::Matrix18d;
using estimator::NodeState;

constexpr std::uint64_t kWitnessFrom = 2;  // scans, after which the odometry begins

}  // namespace

StepReport GraphLocalizer::start(const Scan& scan) {
  StepReport report = start_->add_scan(scan);
  // One search at a time: the filter's first scans cost enough.
  if (witness_ && scan_number_ >= kWitnessFrom) {
    StageTimes beside;
    {
      StageClock clock(beside);
      witness_->add_scan(scan);
      clock.book(Stage::kOdometry);
    }
    report.times += beside;
    report.odom_epoch = witness_->epoch();
  }
  ++scan_number_;
  const bool found = report.state == State::kTracking || report.state == State::kDegraded;
  if (found) ask_monitor(start_->map(), start_->points(), report);
  // At rest there is nothing to smooth, and the filter knows that the robot does not move.
  if (found && !start_->rests()) take_over();
  return report;
}

void GraphLocalizer::wait(StepReport& report) {
  report.reason = "no pose yet";
  imu_.drop_before(report.pose_time - kImuMemory);
}

void GraphLocalizer::place(const Placement& found) {
  if (start_) {
    map_ = std::make_unique<map::PriorMap>(std::move(*start_).take_map());
    start_.reset();
  }
  const PlacedNode node = place_node(found, witness_->odometry().state(), map_->info().gravity_map,
                                     setup_.graph.gravity_sigma_m_s2);
  smoother_.reset(node.x, node.P);
  witness_->take_motion();
  confirm();
  map_error_.setZero();
  few_told_.clear();
  before_hold_.reset();
  last_mapped_share_ = 1;
  placed_ = true;
}

void GraphLocalizer::confirm() {
  witness_->forget_map();
  if (setup_.monitor) health_.emplace(*setup_.monitor, setup_.places);
}

/// The first node is what the filter knows. It took gravity for known, so that what it holds for
/// the bias of the accelerometer is the sum of both as the body feels it.
void GraphLocalizer::take_over() {
  const filter::FilterState& found = start_->state();
  const double variance = std::pow(setup_.graph.gravity_sigma_m_s2, 2);
  const Eigen::Matrix3d R = found.T_map_body.rotation.toRotationMatrix();
  Matrix18d P = variance * Matrix18d::Identity();
  P.topLeftCorner<15, 15>() = found.P;
  P.diagonal().segment<3>(NodeState::kBa).array() += variance;
  P.block<3, 3>(NodeState::kBa, NodeState::kG) = variance * R.transpose();
  P.block<3, 3>(NodeState::kG, NodeState::kBa) = variance * R;
  smoother_.reset(node_of(found, start_->map().info().gravity_map), P);
  map_ = std::make_unique<map::PriorMap>(std::move(*start_).take_map());
  start_.reset();
}

}  // namespace holdfast::pipeline
