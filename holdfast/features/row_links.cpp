#include "holdfast/features/row_links.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::features {
namespace {

using Eigen::Vector3f;

constexpr int kBins = 1024;              // of azimuth, a third of a degree
constexpr std::int32_t kMostRows = 12;   // that a partner may be away
constexpr std::int32_t kMostMissed = 1;  // rows in between that show nothing straight
constexpr float kParallelSine = 0.06F;   // 3.5 degrees: what tangents of one plane may differ by
constexpr float kBentSine = 0.1F;        // 6 degrees: likewise of normals, beyond their noise
constexpr float kSigmas = 3.0F;
constexpr float kEdgeReach = 0.1F;  // rad: rows of one edge are nearer than this

/// Grows with the azimuth from 0 to 4 over a turn.
int azimuth_bin(const Vector3f& p) {
  const float along = p.x() / (std::abs(p.x()) + std::abs(p.y()) + 1e-12F);
  const float turn = p.y() < 0 ? 1.0F + along : 3.0F - along;
  return std::min(static_cast<int>(turn * (0.25F * kBins)), kBins - 1);
}

/// Part of `v` across the unit vector `t`.
Vector3f across(const Vector3f& v, const Vector3f& t) { return v - v.dot(t) * t; }

}  // namespace

RowLinker::RowLinker(const FeatureConfig& config)
    : window_m_(static_cast<float>(config.window_m)),
      spacing_sq_(static_cast<float>(config.plane_spacing_m * config.plane_spacing_m)) {}

void RowLinker::fill_table() {
  table_.assign(rows_->rows() * kBins, 0);
  for (std::size_t row = 0; row < rows_->rows(); ++row) {
    for (std::uint32_t i = rows_->begin[row]; i < rows_->begin[row + 1]; ++i) {
      if ((*fits_)[i].straight) table_[row * kBins + azimuth_bin(rows_->points[i])] = i + 1;
    }
  }
}

RowLinker::Place RowLinker::place(std::int32_t row, std::uint32_t at) const {
  const WindowFit& fit = (*fits_)[at];
  const Vector3f& p = rows_->points[at];
  const Eigen::Vector2f& t = fit.tangent;
  // Along the row z grows in proportion to the distance from the axis.
  const float rise = p.z() * (p.x() * t.x() + p.y() * t.y()) / p.head<2>().squaredNorm();
  const Vector3f tangent = Vector3f(t.x(), t.y(), rise).normalized();
  return {row, at, p * fit.scale, tangent, fit.sigma_m};
}

RowLinker::Place RowLinker::find(std::int32_t row, int bin) const {
  if (row < 0 || row >= static_cast<std::int32_t>(rows_->rows())) return {};
  const std::uint32_t* cells = &table_[static_cast<std::size_t>(row) * kBins];
  for (const int step : {0, 1, -1, 2, -2}) {
    const int b = (bin + step) & (kBins - 1);
    if (cells[b] > 0) return place(row, cells[b] - 1);
  }
  return {};
}

/// The nearest straight window above (direction 1) or below (-1) that is at least half a window
/// away, when all windows up to there have parallel tangents.
RowLinker::Place RowLinker::partner(const Place& from, int bin, std::int32_t direction) const {
  std::int32_t missed = 0;
  for (std::int32_t k = 1; k <= kMostRows && missed <= kMostMissed; ++k) {
    const Place other = find(from.row + k * direction, bin);
    if (!other) {
      ++missed;
      continue;
    }
    const Vector3f away = across(other.position - from.position, from.tangent);
    const float least = 0.5F * window_m_;
    const float apart_sq = away.squaredNorm();
    if (apart_sq < 1e-8F) continue;
    const Vector3f normal = from.tangent.cross(away) / std::sqrt(apart_sq);
    if (std::abs(normal.dot(other.tangent)) > kParallelSine ||
        from.tangent.dot(other.tangent) < 0.9F) {
      return {};
    }
    if (apart_sq >= least * least) return other;
  }
  return {};
}

/// Two partners in a line with the point: one on each side, or both on one side where the field or
/// the surface ends.
bool RowLinker::plane_through(const Place& from, int bin, Feature& plane) const {
  Place up = partner(from, bin, 1);
  Place down = partner(from, bin, -1);
  if (!up && !down) return false;
  const Place* middle = &from;
  Place low = down, high = up;
  if (!down) {
    middle = &up;
    low = from;
    high = partner(up, bin, 1);
  } else if (!up) {
    middle = &down;
    low = partner(down, bin, -1);
    high = from;
  }
  if (!low || !high) return false;
  const Vector3f& t = middle->tangent;
  const Vector3f before = across(middle->position - low.position, t);
  const Vector3f after = across(high.position - middle->position, t);
  const float b = before.norm();
  const float a = after.norm();
  const float bend = before.cross(after).norm() / (a * b);
  const float noise =
      std::hypot(low.sigma_m, middle->sigma_m) / b + std::hypot(middle->sigma_m, high.sigma_m) / a;
  if (before.dot(after) < 0 || bend > std::min(kBentSine + kSigmas * noise, 0.5F)) return false;
  plane.axis = t.cross(high.position - low.position).normalized();
  if (plane.axis.dot(from.position) > 0) plane.axis = -plane.axis;
  return true;
}

void RowLinker::find_planes(const ScanRows& rows, const std::vector<WindowFit>& fits,
                            std::vector<Feature>& out) {
  rows_ = &rows;
  fits_ = &fits;
  fill_table();
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const Vector3f* last = nullptr;
    for (std::uint32_t i = rows.begin[row]; i < rows.begin[row + 1]; ++i) {
      if (!fits[i].straight) continue;
      const Vector3f& p = rows.points[i];
      if (last != nullptr && (p - *last).squaredNorm() < spacing_sq_) continue;
      const Place from = place(static_cast<std::int32_t>(row), i);
      Feature plane{rows.source[i], from.position, Vector3f::Zero(), from.sigma_m};
      last = &p;
      if (plane_through(from, azimuth_bin(p), plane)) out.push_back(plane);
    }
  }
}

/// The edge of a row that is nearest to `to`, within a window or the distance of some rows.
const RowEdge* RowLinker::nearest(const std::vector<RowEdge>& edges, std::size_t row,
                                  const Vector3f& to) const {
  if (row >= row_edges_.size() || row + 1 == row_edges_.size()) return nullptr;  // also row -1
  const float reach = std::max(window_m_, kEdgeReach * to.norm());
  float least = reach * reach;
  const RowEdge* found = nullptr;
  for (std::size_t e = row_edges_[row]; e < row_edges_[row + 1]; ++e) {
    const float far = (edges[e].position - to).squaredNorm();
    if (far >= least) continue;
    least = far;
    found = &edges[e];
  }
  return found;
}

void RowLinker::direct_edges(const ScanRows& rows, const std::vector<RowEdge>& edges,
                             std::vector<Feature>& out) {
  row_edges_.clear();
  std::size_t e = 0;
  for (const std::uint32_t begin : rows.begin) {
    while (e < edges.size() && edges[e].at < begin) ++e;
    row_edges_.push_back(e);
  }
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    for (e = row_edges_[row]; e < row_edges_[row + 1]; ++e) {
      const Vector3f& p = edges[e].position;
      const RowEdge* up = nearest(edges, row + 1, p);
      const RowEdge* down = nearest(edges, row - 1, p);
      Feature edge{rows.source[edges[e].at], p, Vector3f::Zero(), edges[e].sigma_m};
      if (up != nullptr || down != nullptr) {
        edge.axis = ((up != nullptr ? up->position : p) - (down != nullptr ? down->position : p))
                        .normalized();
      }
      out.push_back(edge);
    }
  }
}

}  // namespace holdfast::features
