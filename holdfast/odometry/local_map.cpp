#include "holdfast/odometry/local_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "holdfast/registration/associate.hpp"

template std::size_t holdfast::registration::associate(const odometry::LocalMap& map,
                                                       const SE3& T_anchor_body,
                                                       const Eigen::Vector3d& p_body_lidar,
                                                       const BodyPoints& points,
                                                       const AssociationOptions& options,
                                                       WorkerPool& pool, Correspondences& out);

namespace holdfast::odometry {
namespace {

constexpr std::array<std::size_t, LocalMap::kLevels> kCapacity = {1U << 17, 1U << 16};
constexpr std::size_t kSweepCells = 4096;  // looked at in one scan
constexpr double kAnchorReachM = 32.0;     // from the robot; float is good to 4 micrometres there
constexpr float kRangeOfHalfWeightM = 40;  // 0.5 mrad are as much as the noise of a range
constexpr float kFirstFit = 6;
constexpr float kGrowth = 1.25F;   // between fits
constexpr float kFloorM = 0.003F;  // roughness that every wall has
constexpr float kFanM = 0.25F;     // nearer to the LiDAR no plane passes
constexpr float kFanSine = 0.04F;  // nor at a smaller angle to the rays
constexpr double kLeastRadiusM = 10.0;
constexpr double kNearlyFull = 0.95, kRoomy = 0.7;

}  // namespace

LocalMap::LocalMap(const LocalMapConfig& config, double range_sigma_m)
    : config_(config), range_variance_(static_cast<float>(range_sigma_m * range_sigma_m)) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    level.cell_m = static_cast<float>(config.cell_m) * static_cast<float>(1U << i);
    level.cells_per_m = 1.0F / level.cell_m;
    level.cells.resize(kCapacity[i]);
    level.free.reserve(kCapacity[i]);
  }
  clear();
}

void LocalMap::clear() {
  for (Level& level : levels_) {
    level.table.reset(level.cells.size());
    level.free.clear();
    for (std::size_t i = level.cells.size(); i-- > 0;) {
      level.cells[i].in_use = false;
      level.free.push_back(static_cast<std::uint32_t>(i));
    }
    level.swept = 0;
    level.radius_m = config_.radius_m;
    level.anchor_cell.setZero();
  }
  anchor_.setZero();
}

void LocalMap::insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_body,
                      const Eigen::Vector3d& p_body_lidar) {
  const Eigen::Matrix3f R = T_odom_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = (T_odom_body.translation - anchor_).cast<float>();
  const Eigen::Vector3f lidar = p_body_lidar.cast<float>();
  const Eigen::Vector3f lidar_in_map = R * lidar + t;
  constexpr float kHalf = 1.0F / (kRangeOfHalfWeightM * kRangeOfHalfWeightM);
  for (const Eigen::Vector3f& q : points) {
    const float weight = 1.0F / (1.0F + (q - lidar).squaredNorm() * kHalf);
    const Sighting seen{R * q + t, lidar_in_map, weight};
    for (Level& level : levels_) add(level, seen);
  }
}

void LocalMap::add(Level& level, const Sighting& seen) {
  const Eigen::Vector3i local = (seen.p * level.cells_per_m).array().floor().cast<int>();
  const std::uint64_t key = cell_key(local + level.anchor_cell);
  std::uint32_t at = level.table.find(key);
  if (at == CellTable::kNone) {
    if (level.free.empty()) {
      ++refused_;
      return;
    }
    at = level.free.back();
    level.free.pop_back();
    level.table.insert(key, at);
    level.cells[at] = Cell{};
    level.cells[at].key = key;
    level.cells[at].in_use = true;
    level.cells[at].refit_at = kFirstFit;
  }
  const Eigen::Vector3f centre = (local.cast<float>().array() + 0.5F) * level.cell_m;
  add_to(level, level.cells[at], {seen.p - centre, seen.lidar - centre, seen.weight});
}

void LocalMap::add_to(const Level& level, Cell& cell, const Sighting& seen) {
  if (cell.weight >= static_cast<float>(config_.full_weight)) return;
  // West's running moments: nothing cancels.
  const float sum = cell.weight + seen.weight;
  const Eigen::Vector3f d = seen.p - cell.mean;
  const float share = seen.weight / sum;
  const float w = cell.weight * share;
  cell.mean += share * d;
  cell.seen_from += share * (seen.lidar - cell.seen_from);
  cell.scatter[0] += w * d.x() * d.x();
  cell.scatter[1] += w * d.x() * d.y();
  cell.scatter[2] += w * d.x() * d.z();
  cell.scatter[3] += w * d.y() * d.y();
  cell.scatter[4] += w * d.y() * d.z();
  cell.scatter[5] += w * d.z() * d.z();
  cell.weight = sum;
  if (sum >= cell.refit_at) fit(level, cell);
}

/// Points of one beam that bends round a corner lie in the plane in which the beam turns. It would
/// travel with the LiDAR and hold it back; a wall is known from it by passing at a distance.
bool LocalMap::is_fan(const Cell& cell, const Eigen::Vector3f& normal) const {
  const Eigen::Vector3f ray = cell.mean - cell.seen_from;
  const float past = std::abs(normal.dot(ray));
  return past < kFanM || past < kFanSine * ray.norm();
}

void LocalMap::fit(const Level& level, Cell& cell) const {
  cell.refit_at = kGrowth * cell.weight;
  const auto& s = cell.scatter;
  Eigen::Matrix3d scatter;
  scatter << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter / cell.weight);
  const Eigen::Vector3f variance = solver.eigenvalues().cwiseMax(0.0).cast<float>();
  const float n = cell.weight;
  const float noise = range_variance_ + kFloorM * kFloorM;
  const auto slack = static_cast<float>(config_.noise_slack * config_.noise_slack);
  const bool thin = variance[0] <= noise * slack * (1.0F + 2.0F * std::sqrt(2.0F / n));
  cell.surface.more = 0;
  cell.surface.support = static_cast<std::uint16_t>(std::min(n, 65535.0F));
  if (!thin) {
    cell.surface.kind = map::SurfaceKind::kClutter;
    cell.known = true;
    return;
  }
  // Error of the plane over the cell: of its offset, and of its two tilts at a typical lever.
  const float scale = std::max(variance[0] * n / std::max(n - 3.0F, 1.0F), 0.25F * noise);
  const float lever_sq = level.cell_m * level.cell_m / 12.0F;
  const float tilts =
      lever_sq / std::max(variance[1], 1e-8F) + lever_sq / std::max(variance[2], 1e-8F);
  const float sigma = std::sqrt(scale / n * (1.0F + tilts));
  cell.surface.kind = map::SurfaceKind::kPlane;
  cell.surface.center = cell.mean;
  cell.surface.normal = solver.eigenvectors().col(0).cast<float>().normalized();
  cell.surface.sigma_m = sigma;
  cell.known =
      sigma < static_cast<float>(config_.plane_sigma_m) && !is_fan(cell, cell.surface.normal);
}

void LocalMap::set_anchor(const Eigen::Vector3d& p_odom) {
  const Level& coarsest = levels_.back();
  const double side = coarsest.cell_m;
  const Eigen::Vector3i cell = (p_odom / side).array().floor().cast<int>();
  anchor_ = cell.cast<double>() * side;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    levels_[i].anchor_cell = cell * (1 << (levels_.size() - 1 - i));
  }
}

void LocalMap::follow(const Eigen::Vector3d& p_odom) {
  if ((p_odom - anchor_).norm() > kAnchorReachM) set_anchor(p_odom);
  for (Level& level : levels_) forget_far(level, p_odom);
}

void LocalMap::forget_far(Level& level, const Eigen::Vector3d& p_odom) {
  const auto share = static_cast<double>(level.used()) / static_cast<double>(level.cells.size());
  if (share > kNearlyFull) level.radius_m = std::max(kLeastRadiusM, 0.95 * level.radius_m);
  if (share < kRoomy) level.radius_m = std::min(config_.radius_m, 1.02 * level.radius_m);
  const double most = level.radius_m * level.radius_m;
  for (std::size_t k = 0; k < kSweepCells; ++k) {
    level.swept = level.swept + 1 < level.cells.size() ? level.swept + 1 : 0;
    Cell& cell = level.cells[level.swept];
    if (!cell.in_use) continue;
    const Eigen::Vector3d p = cell_of(cell.key).cast<double>() * static_cast<double>(level.cell_m);
    if ((p - p_odom).squaredNorm() <= most) continue;
    level.table.erase(cell.key);
    cell.in_use = false;
    level.free.push_back(static_cast<std::uint32_t>(level.swept));
  }
}

std::size_t LocalMap::memory_bytes() const {
  std::size_t bytes = sizeof(*this);
  for (const Level& level : levels_) {
    bytes += level.table.memory_bytes() + level.cells.capacity() * sizeof(Cell) +
             level.free.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace holdfast::odometry
