#include "holdfast/filter/matching/scan_match.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::filter {
namespace {

using registration::kVelocity;
using registration::NormalEquations;

// Changes below which another pairing or deskewing would change nothing that matters.
constexpr double kRepairM = 0.02;
constexpr double kRepairRad = 0.002;
constexpr double kRedeskewM = 0.002;
constexpr double kRedeskewRad = 0.0002;
// The robust loss starts wide and narrows: far from the optimum its narrow form hardly feels the
// pairs that are off, and takes many small steps.
constexpr std::array<double, ScanMatch::kCalls> kAnneal = {4.0, 2.0, 1.0};

SE3 anchored(const SE3& T_map_body, const ScanPairing& map) {
  return {T_map_body.rotation, T_map_body.translation - map.anchor()};
}

}  // namespace

void ScanMatch::book(Stage stage) {
  if (clock_ != nullptr) clock_->book(stage);
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

void deskew_scan(const SelectedScan& scan, const MatchState& x, UpdateWorkspace& work) {
  const Scan& s = *scan.scan;
  const Eigen::Quaterniond R_body_map = x.T_map_body.rotation.conjugate();
  work.motion.set(scan.imu,
                  {R_body_map * x.v_map, R_body_map * x.gravity_map, x.gyro_bias, x.accel_bias},
                  scan.T_body_lidar, s.stamp, s.end_time);
  work.points.resize(scan.selected.size());
  const auto span_s = static_cast<float>(to_seconds(s.end_time - s.stamp));
  for (std::size_t i = 0; i < scan.selected.size(); ++i) {
    const ScanPoint& p = s.points[scan.selected[i]];
    work.points.points[i] = work.motion.deskew(p);
    work.points.age_s[i] = static_cast<float>(p.time_offset_ns) * 1e-9F - span_s;
  }
}

double ScanMatch::span_s() const { return to_seconds(scan_.scan->end_time - scan_.scan->stamp); }

void ScanMatch::deskew(const MatchState& x) {
  deskew_scan(scan_, x, work_);
  deskewed_ = x;
  book(Stage::kDeskew);
}

void ScanMatch::pair(const MatchState& x) {
  map_.associate(anchored(x.T_map_body, map_), scan_.T_body_lidar.translation, work_.points,
                 options_.association, pool_, work_.pairs);
  paired_ = x.T_map_body;
  book(Stage::kAssociate);
}

/// Have velocity or turning rate moved the points by more than matters?
bool ScanMatch::is_stale(const MatchState& x) const {
  return (x.v_map - deskewed_.v_map).norm() * span_s() > kRedeskewM ||
         (x.gyro_bias - deskewed_.gyro_bias).norm() * span_s() > kRedeskewRad;
}

void ScanMatch::refresh(const MatchState& x, bool by_skew) {
  const bool stale = calls_ == 0 || by_skew || is_stale(x);
  if (stale) deskew(x);
  const bool far = (x.T_map_body.translation - paired_.translation).norm() > kRepairM ||
                   so3::angle_between(x.T_map_body.rotation, paired_.rotation) > kRepairRad;
  if (stale || far) pair(x);
}

/// What the pairs say of pose and velocity.
ScanEquations ScanMatch::without_skew(const MatchState& x) const {
  ScanEquations e;
  e.H.topLeftCorner<9, 9>() = raw_.H;
  // The points still stand where the velocity of the last deskewing put them.
  e.g.head<9>() = raw_.g + raw_.H.middleCols<3>(kVelocity) * (x.v_map - deskewed_.v_map);
  if (!options_.velocity_from_skew) fix_velocity(e);
  return e;
}

/// The map's own error as this scan feels it. Over the time of the scan it may change by as much as
/// it is, and part of the information may be feigned.
MapError ScanMatch::map_error() const {
  MapError error;
  error.pose.setZero();
  error.pose.topLeftCorner<3, 3>() = registration::feigned_offset(raw_);
  error.pose.diagonal().head<3>().array() += std::pow(options_.map_sigma_m, 2);
  error.pose.diagonal().tail<3>().array() += std::pow(options_.map_sigma_rad, 2);
  error.velocity_m_s = 2.0 * options_.map_sigma_m / std::max(span_s(), 1e-3);
  return error;
}

ScanEquations ScanMatch::linearise(const MatchState& x, bool by_skew) {
  refresh(x, by_skew);
  const auto call = std::min(static_cast<std::size_t>(calls_++), kAnneal.size() - 1);
  const double scale = kAnneal[call] * options_.robust_scale;
  const SE3 T_anchor_body = anchored(x.T_map_body, map_);
  raw_ = registration::linearise(work_.pairs, T_anchor_body, scale, pool_, work_.partials);
  raw_.feigned = registration::feigned_information(raw_, work_.pairs, T_anchor_body, scale,
                                                   options_.few_pairs);
  ScanEquations e =
      by_skew ? linearise_with_skew(work_.pairs, T_anchor_body, scale) : without_skew(x);
  marginalise(map_error(), e);
  book(Stage::kSolve);
  return e;
}

}  // namespace holdfast::filter
