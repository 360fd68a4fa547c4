#include "holdfast/pipeline/methods/query_matching.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "holdfast/filter/account.hpp"

namespace holdfast::pipeline {
namespace {

using filter::FilterState;

constexpr double kLeverM = 10.0;  // at which an error of the rotation is as large as of a range
constexpr TimeNs kImuMemory = 2 * kSecond;

}  // namespace

Result<std::unique_ptr<ScanLocalizer>> QueryMatching::create(map::PriorMap map, const Setup& setup,
                                                             const SE3& T_map_body) {
  auto clouds = registration::classify_points(map.dir());
  if (!clouds) return clouds.error();
  return std::unique_ptr<ScanLocalizer>(
      new QueryMatching(std::move(map), std::move(*clouds), setup, T_map_body));
}

QueryMatching::QueryMatching(map::PriorMap map, registration::FeatureClouds clouds,
                             const Setup& setup, const SE3& T_map_body)
    : setup_(setup),
      gravity_map_(map.info().gravity_map),
      origin_(map.info().origin),
      start_(std::move(map), setup.start, T_map_body),
      matcher_(std::move(clouds), setup.matching),
      extractor_(setup.features, setup.start.range_sigma_m) {}

void QueryMatching::add_imu(const ImuSample& sample) {
  imu_.add(sample);
  if (!started_) start_.add_imu(sample);
}

StepReport QueryMatching::add_scan(const Scan& scan) {
  if (!started_) {
    StepReport report = start_.add_scan(scan);
    started_ = report.state == State::kTracking || report.state == State::kDegraded;
    if (started_) state_ = start_.state();
    return report;
  }
  StepReport report;
  report.stamp = scan.stamp;
  report.pose_time = scan.end_time;
  {
    StageClock clock(report.times);
    step(scan, clock, report);
    clock.book(Stage::kHealth);
  }
  return report;
}

void QueryMatching::step(const Scan& scan, StageClock& clock, StepReport& report) {
  report.T_map_body = state_.T_map_body;
  if (scan.end_time <= state_.t || !imu_.segment(state_.t, scan.end_time, segment_)) {
    report.state = State::kDeadReckoning;
    report.reason = "scan is not later than the one before";
    return;
  }
  report.imu_held_ns = segment_.held_ns;
  filter::propagate(state_, segment_, gravity_map_, setup_.start.imu);
  report.T_map_predicted = state_.T_map_body;
  clock.book(Stage::kPredict);
  extractor_.extract(scan, found_);
  clock.book(Stage::kSelect);
  deskew(scan);
  clock.book(Stage::kDeskew);
  const registration::FitAtQueryResult found = match();
  if (found.valid) correct(found.T_map_body);
  clock.book(Stage::kSolve);
  describe(found, report);
  judge(found.valid, report);
  imu_.drop_before(scan.end_time - kImuMemory);
}

void QueryMatching::describe(const registration::FitAtQueryResult& found,
                             StepReport& report) const {
  const int matches = found.edges + found.planes;
  report.T_map_body = state_.T_map_body;
  report.matches = matches;
  report.inlier_share =
      static_cast<double>(matches) /
      std::max<double>(1, static_cast<double>(found_.edges.size() + found_.planes.size()));
  // Article 3.4.1; means of absolute values, since the signed ones cancel.
  report.mean_abs_residual_m =
      (found.edges * found.mean_abs_edge_m + found.planes * found.mean_abs_plane_m) /
      std::max(1, matches);
  filter::report_covariance(state_.P.topLeftCorner<6, 6>(), report);
}

/// Article 3.1.2, to the last point (see preprocess::ScanMotion).
void QueryMatching::deskew(const Scan& scan) {
  const Eigen::Quaterniond R_body_map = state_.T_map_body.rotation.conjugate();
  imu_.segment(scan.stamp, scan.end_time, segment_);
  motion_.set(
      segment_,
      {R_body_map * state_.v_map, R_body_map * gravity_map_, state_.gyro_bias, state_.accel_bias},
      setup_.start.T_body_lidar, scan.stamp, scan.end_time);
  const auto& limits = setup_.start.selection;
  const auto place = [&](const std::vector<features::Feature>& found, auto& cloud) {
    cloud.clear();
    for (const features::Feature& f : found) {
      const ScanPoint& p = scan.points[f.index];
      const double range = Eigen::Vector3d(p.x, p.y, p.z).norm();
      if (range < limits.min_range_m || range > limits.max_range_m) continue;
      cloud.push_back(motion_.deskew(p));
    }
  };
  place(found_.edges, scan_.edges);
  place(found_.planes, scan_.planes);
}

registration::FitAtQueryResult QueryMatching::match() const {
  SE3 pose = state_.T_map_body;
  pose.translation -= origin_;
  registration::FitAtQueryResult found = matcher_.align(scan_, pose);
  found.T_map_body.translation += origin_;
  return found;
}

/// The measured pose as one of the whole state, by its cross-covariances.
void QueryMatching::correct(const SE3& measured) {
  constexpr int kPose = 6;
  Eigen::Matrix<double, kPose, 1> sigma;
  sigma.head<3>().setConstant(setup_.start.range_sigma_m);
  sigma.tail<3>().setConstant(setup_.start.range_sigma_m / kLeverM);
  const Eigen::Matrix<double, kPose, kPose> R = sigma.cwiseAbs2().asDiagonal();
  const Eigen::Matrix<double, kPose, kPose> S = state_.P.topLeftCorner<kPose, kPose>() + R;
  const Eigen::Matrix<double, 15, kPose> K = S.ldlt().solve(state_.P.topRows<kPose>()).transpose();
  Eigen::Matrix<double, kPose, 1> innovation;
  innovation << measured.translation - state_.T_map_body.translation,
      so3::log(state_.T_map_body.rotation.conjugate() * measured.rotation);
  filter::Matrix15d I_KH = filter::Matrix15d::Identity();
  I_KH.leftCols<kPose>() -= K;
  state_.P = (I_KH * state_.P * I_KH.transpose() + K * R * K.transpose()).eval();
  state_.add(K * innovation);
}

/// Article 4.1.1: too few matches make a scan worthless.
void QueryMatching::judge(bool valid, StepReport& report) const {
  if (report.sigma_trans_m > setup_.start.filter.lost_sigma_m) {
    report.state = State::kLost;
    report.reason = "too long without a scan that fits the map";
  } else if (!valid) {
    report.state = State::kDeadReckoning;
    report.reason = "too few features match the map";
  } else {
    report.state = State::kTracking;
  }
}

}  // namespace holdfast::pipeline
