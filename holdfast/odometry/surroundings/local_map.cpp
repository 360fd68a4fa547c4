#include "holdfast/odometry/surroundings/local_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

namespace holdfast::odometry {
namespace {

constexpr std::array<std::size_t, LocalMap::kSizes> kCapacity = {1U << 17, 1U << 16, 1U << 15};
constexpr std::size_t kBlock = 64;         // points that go into the map together
constexpr std::size_t kSweepScans = 64;    // until all cells have been looked at
constexpr double kAnchorReachM = 32.0;     // from the robot; float is good to 4 micrometres there
constexpr float kRangeOfHalfWeightM = 40;  // 0.5 mrad are as much as the noise of a range
constexpr float kFirstFit = 6;
constexpr float kGrowth = 1.25F;         // between fits
constexpr float kFloorM = 0.003F;        // roughness that every wall has
constexpr float kFanM = 0.25F;           // nearer to the LiDAR no plane passes
constexpr float kFanSine = 0.04F;        // nor at a smaller angle to the rays
constexpr float kBeamsPerSlope = 57.0F;  // beams are told apart at a degree
constexpr double kOtherPlaceM = 0.2;     // from which the lines are others
constexpr float kAngleSigma = 0.0005F;   // error of the rotation, rad
constexpr double kLeastRadiusM = 10.0;
constexpr float kFirmSupport = 20;  // points of a plane that is firm
constexpr int kFirmLines = 3;       // and lines: the third tells whether two lie on a plane
constexpr double kNearlyFull = 0.95, kRoomy = 0.7;

}  // namespace

LocalMap::LocalMap(const LocalMapConfig& config, double range_sigma_m)
    : config_(config), range_variance_(static_cast<float>(range_sigma_m * range_sigma_m)) {
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    layer.cell_m = static_cast<float>(config.cell_m) * static_cast<float>(1U << i);
    layer.cells_per_m = 1.0F / layer.cell_m;
    layer.cells.resize(kCapacity[i]);
    layer.surfaces.resize(kCapacity[i]);
    layer.free.reserve(kCapacity[i]);
  }
  clear();
}

void LocalMap::clear() {
  for (Layer& layer : layers_) {
    layer.table.reset(layer.cells.size());
    layer.keys.assign(layer.cells.size(), kNoCell);
    layer.free.clear();
    for (std::size_t i = layer.cells.size(); i-- > 0;) {
      layer.free.push_back(static_cast<std::uint32_t>(i));
    }
    layer.swept = 0;
    layer.radius_m = config_.radius_m;
    layer.anchor_cell.setZero();
  }
  anchor_.setZero();
  stood_.setConstant(1e9);
  place_ = 0;
}

void LocalMap::insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_body,
                      const Eigen::Vector3d& p_body_lidar, std::size_t most, std::uint64_t number) {
  const Eigen::Matrix3f R = T_odom_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = (T_odom_body.translation - anchor_).cast<float>();
  const Eigen::Vector3f lidar = p_body_lidar.cast<float>();
  const Eigen::Vector3f lidar_in_map = R * lidar + t;
  const Eigen::Vector3d stands = T_odom_body * p_body_lidar;
  if ((stands - stood_).norm() > kOtherPlaceM) {
    stood_ = stands;
    ++place_;
  }
  constexpr float kHalf = 1.0F / (kRangeOfHalfWeightM * kRangeOfHalfWeightM);
  const std::size_t stride = points.size() / most + (points.size() % most != 0 ? 1 : 0);
  for (std::size_t i = stride > 1 ? number % stride : 0; i < points.size(); i += stride) {
    const Eigen::Vector3f& q = points[i];
    const Eigen::Vector3f ray = q - lidar;
    const float weight = 1.0F / (1.0F + ray.squaredNorm() * kHalf);
    const float slope = ray.z() / ray.head<2>().norm() * kBeamsPerSlope;
    const auto beam = static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::floor(std::clamp(slope, -1e6F, 1e6F))));
    const Sighting seen{R * q + t, lidar_in_map, weight, 1U << ((beam + 7 * place_) % 32)};
    block_.push_back(seen);
    if (block_.size() < kBlock) continue;
    add(block_);
    block_.clear();
  }
  add(block_);
  block_.clear();
}

/// Cells lie anywhere in memory: what all points of a block need is fetched at the same time.
void LocalMap::add(const std::vector<Sighting>& seen) {
  for (const Sighting& s : seen) {
    for (const Layer& layer : layers_) layer.table.prefetch(layer.key_of(s.p));
  }
  for (const Sighting& s : seen) {
    for (const Layer& layer : layers_) {
      const CellTable::Entry& entry = layer.table.look_up(layer.key_of(s.p));
      if (entry.index != CellTable::kNone) __builtin_prefetch(&layer.cells[entry.index], 1);
    }
  }
  for (const Sighting& s : seen) {
    for (Layer& layer : layers_) add(layer, s);
  }
}

void LocalMap::add(Layer& layer, const Sighting& seen) {
  const Eigen::Vector3i local = layer.cell_of(seen.p);
  const std::uint64_t key = cell_key(local + layer.anchor_cell);
  const CellTable::Entry& entry = layer.table.look_up(key);
  if ((entry.flags & kFull) != 0) return;
  std::uint32_t at = entry.index;
  if (at == CellTable::kNone) {
    if (layer.free.empty()) {
      ++refused_;
      return;
    }
    at = layer.free.back();
    layer.free.pop_back();
    layer.table.insert(key, at);
    layer.keys[at] = key;
    layer.cells[at] = Cell{};
    layer.cells[at].refit_at = kFirstFit;
  }
  const Eigen::Vector3f centre = (local.cast<float>().array() + 0.5F) * layer.cell_m;
  Cell& cell = layer.cells[at];
  const bool grown = add_to(cell, {seen.p - centre, seen.lidar - centre, seen.weight, seen.line});
  std::uint32_t flags = grown ? fit(layer, cell, layer.surfaces[at]) : cell.flags;
  if (cell.weight >= static_cast<float>(config_.full_weight)) flags |= kFull;
  if (flags == cell.flags) return;
  cell.flags = flags;
  layer.table.set_flags(key, flags);
}

/// True where the plane is to be fitted anew.
bool LocalMap::add_to(Cell& cell, const Sighting& seen) const {
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
  cell.lines |= seen.line;
  cell.weight = sum;
  return sum >= cell.refit_at;
}

/// Points of one beam that bends round a corner, or runs along a wall with its noise, lie in the
/// plane in which the beam turns. It would travel with the LiDAR and hold it back; a wall is known
/// from it by passing the LiDAR at a distance.
/// Returns the flags of the cell.
std::uint32_t LocalMap::fit(const Layer& layer, Cell& cell, map::Surface& surface) const {
  cell.refit_at = kGrowth * cell.weight;
  const auto& s = cell.scatter;
  Eigen::Matrix3d scatter;
  scatter << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter / cell.weight);
  const Eigen::Vector3f variance = solver.eigenvalues().cwiseMax(1e-8).cast<float>();
  Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>().normalized();
  const float n = cell.weight;
  // Noise across the plane as its points were seen.
  const Eigen::Vector3f ray = cell.mean - cell.seen_from;
  if (normal.dot(ray) > 0) normal = -normal;
  const float past = -normal.dot(ray);
  const float noise = range_variance_ * past * past / ray.squaredNorm() + kFloorM * kFloorM +
                      kAngleSigma * kAngleSigma * ray.squaredNorm();
  const auto slack = static_cast<float>(config_.noise_slack * config_.noise_slack);
  if (std::popcount(cell.lines) < least_lines_) return 0;
  if (variance[0] > slack * noise * (1.0F + 2.0F * std::sqrt(2.0F / n))) return 0;
  if (past < kFanM || past < kFanSine * ray.norm()) return 0;
  // Error of the plane over the cell: of its offset, and of its two tilts at a typical lever.
  const float scale = std::max(variance[0], 0.5F * noise) / n;
  const float tilt = scale / variance[1];
  const float lever_sq = layer.cell_m * layer.cell_m / 12.0F;
  const float sigma_sq = scale + lever_sq * (tilt + scale / variance[2]);
  const auto most = static_cast<float>(config_.plane_sigma_m);
  const auto most_tilt = static_cast<float>(config_.tilt_sigma_rad);
  if (sigma_sq >= most * most || tilt >= most_tilt * most_tilt) return 0;
  // Firm: the tilt is known without trust in the luck of few points.
  const float tilt_at_worst = std::max(variance[0], noise) / (n - 3.0F) / variance[1];
  const bool firm = n >= kFirmSupport && std::popcount(cell.lines) >= kFirmLines &&
                    tilt_at_worst < most_tilt * most_tilt;
  surface = {cell.mean,
             normal,
             std::sqrt(sigma_sq),
             static_cast<std::uint16_t>(std::min(n, 65535.0F)),
             map::SurfaceKind::kPlane,
             0};
  return firm ? kPlane | kFirm : kPlane;
}

void LocalMap::set_anchor(const Eigen::Vector3d& p_odom) {
  const Layer& coarsest = layers_.back();
  const double side = coarsest.cell_m;
  const Eigen::Vector3i cell = (p_odom / side).array().floor().cast<int>();
  anchor_ = cell.cast<double>() * side;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i].anchor_cell = cell * (1 << (layers_.size() - 1 - i));
  }
}

void LocalMap::follow(const Eigen::Vector3d& p_odom) {
  if ((p_odom - anchor_).norm() > kAnchorReachM) set_anchor(p_odom);
  for (Layer& layer : layers_) forget_far(layer, p_odom);
}

void LocalMap::forget_far(Layer& layer, const Eigen::Vector3d& p_odom) {
  const auto share = static_cast<double>(layer.used()) / static_cast<double>(layer.cells.size());
  if (share > kNearlyFull) layer.radius_m = std::max(kLeastRadiusM, 0.95 * layer.radius_m);
  if (share < kRoomy) layer.radius_m = std::min(config_.radius_m, 1.02 * layer.radius_m);
  const double most = layer.radius_m * layer.radius_m;
  for (std::size_t k = 0; k < layer.cells.size() / kSweepScans; ++k) {
    layer.swept = layer.swept + 1 < layer.cells.size() ? layer.swept + 1 : 0;
    std::uint64_t& key = layer.keys[layer.swept];
    if (key == kNoCell) continue;
    const Eigen::Vector3d p = cell_of(key).cast<double>() * static_cast<double>(layer.cell_m);
    if ((p - p_odom).squaredNorm() <= most) continue;
    layer.table.erase(key);
    key = kNoCell;
    layer.free.push_back(static_cast<std::uint32_t>(layer.swept));
  }
}

std::size_t LocalMap::memory_bytes() const {
  std::size_t bytes = sizeof(*this);
  for (const Layer& layer : layers_) {
    bytes += layer.table.memory_bytes() + layer.cells.capacity() * sizeof(Cell) +
             layer.surfaces.capacity() * sizeof(map::Surface) +
             layer.keys.capacity() * sizeof(std::uint64_t) +
             layer.free.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

}  // namespace holdfast::odometry
