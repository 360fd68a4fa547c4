#include "evaluation/relative_error.hpp"

#include <numbers>

namespace holdfast::evaluation {
namespace {

SE3 relative_pose_error(const ScanRecord& from, const ScanRecord& to) {
  const SE3 true_motion = from.truth.T_map_body.inverse() * to.truth.T_map_body;
  const SE3 claimed_motion = from.T_map_body.inverse() * to.T_map_body;
  return true_motion.inverse() * claimed_motion;
}

bool connected(const ScanRecord& from, const ScanRecord& to, bool break_at_epochs) {
  return from.truth.stretch == to.truth.stretch &&
         !(break_at_epochs && from.odom_epoch != to.odom_epoch);
}

}  // namespace

RelativeError relative_error(const std::vector<ScanRecord>& scans, double length_m,
                             bool break_at_epochs) {
  std::vector<const ScanRecord*> known;
  for (const ScanRecord& scan : scans)
    if (scan.has_error()) known.push_back(&scan);
  std::vector<double> trans_m;
  std::vector<double> rot_deg;
  double drift_sum = 0;
  std::size_t end = 0;
  for (const ScanRecord* from : known) {
    const double target_m = from->truth.path_m + length_m;
    while (end < known.size() && known[end]->truth.path_m < target_m) ++end;
    if (end == known.size()) break;
    if (!connected(*from, *known[end], break_at_epochs)) continue;
    const SE3 error = relative_pose_error(*from, *known[end]);
    const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
    trans_m.push_back(error.translation.norm());
    rot_deg.push_back(so3::angle_between(none, error.rotation) * 180 / std::numbers::pi);
    drift_sum += trans_m.back() / (known[end]->truth.path_m - from->truth.path_m);
  }
  RelativeError result;
  result.length_m = length_m;
  result.segments = trans_m.size();
  if (trans_m.empty()) return result;
  result.trans_rmse_m = error_statistics(trans_m).rmse;
  result.rot_rmse_deg = error_statistics(rot_deg).rmse;
  result.drift_percent = 100 * drift_sum / static_cast<double>(trans_m.size());
  return result;
}

}  // namespace holdfast::evaluation
