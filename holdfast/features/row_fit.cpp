#include "holdfast/features/row_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace holdfast::features {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double kWidest = 3.0;         // windows grow to this many times window_m for their points
constexpr double kStride = 0.12;        // of a window: from one to the next that is looked at
constexpr double kClear = 0.5;          // of a window that must be seen on each side
constexpr float kGapSteps = 3.5F;       // a step this much longer than usual: returns are missing
constexpr float kGapInGrid = 12.0F;     // likewise where azimuths are random: once in 4000 steps
constexpr float kGrazing = 0.14F;       // tangent of the least angle between ray and surface
constexpr double kJumpSigmas = 6.0;     // a change of range that noise does not explain
constexpr double kChiSigmas = 3.0;      // of the variance of residuals about a line
constexpr double kTurnSigmas = 5.0;     // of the angle between two lines
constexpr double kOutlierSq = 12.0;     // a point 3.5 sigma off its own window is no plane
constexpr double kSideCosineSq = 0.09;  // a side of an edge is seen within 73 degrees
constexpr double kFaceCosineSq = 0.25;  // a face that ends in a border is seen within 60 degrees

constexpr float kUniformSigma = 0.29F;  // of an even distribution over 1
constexpr double kCurveGain = 12.0;     // sum of squares, in variances, that decides for a shape
constexpr double kTipShare = 1.0;       // squared, of a point that may be a tip
constexpr double kBentSides = 9.0;      // likewise, that speaks against straight sides

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

/// Total least squares through points seen from above.
struct RowFitter::Line {
  double n;
  Vector2d mean;
  Vector2d tangent;  ///< unit, in the order of the row
  double thickness;  ///< mean squared distance to the line, m^2
  double spread;     ///< variance of the points along it, m^2

  Vector2d normal() const { return {-tangent.y(), tangent.x()}; }
  /// Variance of the tangent's direction when each point has `variance` across the line.
  double angle_variance(double variance) const { return variance / (n * spread); }
};

/// How a line and the better of a parabola and a circle explain some points: sums of squared
/// residuals, m^2.
struct RowFitter::Bend {
  double line = 0, curve = 0;
};

RowFitter::RowFitter(const FeatureConfig& config, const RangeNoise& noise)
    : window_sq_(config.window_m * config.window_m),
      widest_sq_(kWidest * kWidest * window_sq_),
      stride_sq_(static_cast<float>(kStride * kStride * window_sq_)),
      clear_sq_(kClear * kClear * window_sq_),
      roughness_sq_(config.roughness_m * config.roughness_m),
      least_side_(static_cast<std::uint32_t>(config.min_side_points)),
      noise_(noise) {
  const double sine = std::sin(config.min_turn_deg * M_PI / 180.0);
  least_turn_sine_sq_ = sine * sine;
  // A sum of n squared residuals of a line has n - 2 degrees of freedom.
  for (std::size_t n = 0; n < chi_limit_.size(); ++n) {
    const double free = std::max(static_cast<double>(n) - 2.0, 1.0);
    chi_limit_[n] =
        free / std::max(static_cast<double>(n), 1.0) * (1.0 + kChiSigmas * std::sqrt(2.0 / free));
  }
}

void RowFitter::fit(const ScanRows& rows, std::vector<WindowFit>& fits,
                    std::vector<RowEdge>& edges) {
  rows_ = &rows;
  fits.assign(rows.size(), {});
  sums_.resize(rows.size() + 1);
  ranges_.resize(rows.size());
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const std::uint32_t begin = rows.begin[row];
    const std::uint32_t end = rows.begin[row + 1];
    if (end - begin < 2 * least_side_ + 1) continue;
    add_up(begin, end);
    const float step = typical_step(begin, end);
    Segment segment{begin, begin, Break::kGap, Break::kGap};
    for (std::uint32_t i = begin; i < end; ++i) {
      segment.after = i + 1 < end ? break_after(i, step) : Break::kGap;
      if (segment.after == Break::kNone) continue;
      segment.end = i + 1;
      fit_segment(segment, fits, edges);
      segment.begin = i + 1;
      segment.before = segment.after;
    }
  }
}

void RowFitter::add_up(std::uint32_t begin, std::uint32_t end) {
  Sums s;
  sums_[begin] = s;
  for (std::uint32_t i = begin; i < end; ++i) ranges_[i] = rows_->points[i].head<2>().norm();
  for (std::uint32_t i = begin; i < end; ++i) {
    const double x = rows_->points[i].x();
    const double y = rows_->points[i].y();
    s.x += x;
    s.y += y;
    s.xx += x * x;
    s.xy += x * y;
    s.yy += y * y;
    sums_[i + 1] = s;
  }
}

/// Median of the azimuth between neighbours (rad, signed by the sense of the row), from some of
/// them.
float RowFitter::typical_step(std::uint32_t begin, std::uint32_t end) {
  constexpr std::uint32_t kSamples = 63;
  steps_.clear();
  for (std::uint32_t k = 0; k < kSamples; ++k) {
    const std::uint32_t i = begin + (end - 1 - begin) * k / kSamples;
    const Vector3f& p = rows_->points[i];
    const Vector3f& q = rows_->points[i + 1];
    const float area = p.x() * q.y() - p.y() * q.x();
    steps_.push_back(area / (p.head<2>().norm() * q.head<2>().norm() + 1e-9F));
  }
  std::nth_element(steps_.begin(), steps_.begin() + kSamples / 2, steps_.end());
  return steps_[kSamples / 2];
}

RowFitter::Break RowFitter::break_after(std::uint32_t i, float step) const {
  const Vector3f& p = rows_->points[i];
  const Vector3f& q = rows_->points[i + 1];
  const float product = ranges_[i] * ranges_[i + 1];
  // The sine of the turn times both ranges, positive in the sense of the row.
  const float area = (p.x() * q.y() - p.y() * q.x()) * (step < 0 ? -1.0F : 1.0F);
  const float usual = std::abs(step) * product;
  if (area < -usual) return Break::kGap;
  // Dark and polished surfaces return some rays only: what is shorter than a window is no hole.
  const bool far = (q - p).squaredNorm() > static_cast<float>(window_sq_);
  if (far && area > (rows_->regular ? kGapSteps : kGapInGrid) * usual) return Break::kGap;
  const float change = ranges_[i + 1] - ranges_[i];
  const float size = std::abs(change);
  const auto least = static_cast<float>(kJumpSigmas * noise_.sigma_m);
  if (size < least) return Break::kNone;
  if (size * kGrazing * std::max(ranges_[i], ranges_[i + 1]) < std::abs(area)) return Break::kNone;
  return change > 0 ? Break::kNearerBefore : Break::kNearerAfter;
}

RowFitter::Line RowFitter::line(std::uint32_t begin, std::uint32_t end) const {
  const Sums& a = sums_[begin];
  const Sums& b = sums_[end];
  const double n = end - begin;
  const double share = 1.0 / n;
  const Vector2d mean((b.x - a.x) * share, (b.y - a.y) * share);
  const double xx = (b.xx - a.xx) * share - mean.x() * mean.x();
  const double xy = (b.xy - a.xy) * share - mean.x() * mean.y();
  const double yy = (b.yy - a.yy) * share - mean.y() * mean.y();
  const double half = 0.5 * (xx - yy);
  const double root = std::sqrt(half * half + xy * xy);
  const double middle = 0.5 * (xx + yy);
  Vector2d tangent = half >= 0 ? Vector2d(half + root, xy) : Vector2d(xy, root - half);
  const Vector3f& first = rows_->points[begin];
  const Vector3f& last = rows_->points[end - 1];
  const double along = tangent.x() * (last.x() - first.x()) + tangent.y() * (last.y() - first.y());
  tangent *= (along < 0 ? -1.0 : 1.0) / std::sqrt(tangent.squaredNorm() + 1e-30);
  return {n, mean, tangent, std::max(middle - root, 0.0), middle + root};
}

/// Expected squared distance from the line of a point near `p`: the range noise, the roughness of
/// surfaces, and that a row on a level plane is not straight but round about the sensor.
double RowFitter::variance_at(const Line& line, const Vector3f& p) const {
  const double range_sq = p.squaredNorm();
  const double per_range_sq = 1.0 / range_sq;
  const double along = line.normal().dot(p.head<2>().cast<double>());
  return noise_.normal_variance(range_sq, along * along * per_range_sq) + roughness_sq_ +
         0.2 * line.spread * line.spread * per_range_sq;
}

bool RowFitter::is_straight(const Line& line, double variance) const {
  const auto n = std::min(static_cast<std::size_t>(line.n), chi_limit_.size() - 1);
  return line.thickness < chi_limit_[n] * variance;
}

/// Far enough from both ends of what is seen.
bool RowFitter::is_clear(std::uint32_t lo, std::uint32_t i, std::uint32_t hi) const {
  const auto& p = rows_->points;
  return (p[lo] - p[i]).squaredNorm() > clear_sq_ && (p[hi] - p[i]).squaredNorm() > clear_sq_;
}

void RowFitter::fit_window(std::uint32_t i, const Line& line, double variance,
                           WindowFit& fit) const {
  const Vector2d p = rows_->points[i].head<2>().cast<double>();
  const Vector2d normal = line.normal();
  const double line_distance = normal.dot(line.mean);
  const double point_distance = normal.dot(p);
  const double off = point_distance - line_distance;
  if (off * off > kOutlierSq * variance) return;
  fit.straight = true;
  fit.tangent = line.tangent.cast<float>();
  fit.sigma_m = static_cast<float>(std::sqrt(variance / line.n));
  fit.scale = static_cast<float>(line_distance / point_distance);
}

/// Fits y = c0 + c1 x + c2 x^2 and a circle x^2 + y^2 = a x + b y + c (Kasa's, linear in its
/// unknowns; its residuals are distances times the diameter) in the coordinates of the line.
RowFitter::Bend RowFitter::bend(std::uint32_t begin, std::uint32_t end, const Line& line) const {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d Az = Eigen::Vector3d::Zero();
  double zz = 0, x3 = 0, x4 = 0, x2y = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vector2d d = rows_->points[i].head<2>().cast<double>() - line.mean;
    const Eigen::Vector3d v(line.tangent.dot(d), cross(line.tangent, d), 1.0);
    const double z = d.squaredNorm();
    A += v * v.transpose();
    Az += z * v;
    zz += z * z;
    const double x2 = v.x() * v.x();
    x3 += x2 * v.x();
    x4 += x2 * x2;
    x2y += x2 * v.y();
  }
  const Eigen::Vector3d circle = A.inverse() * Az;
  const double diameter_sq = circle.head<2>().squaredNorm() + 4.0 * circle.z();
  const double round = std::max(zz - circle.dot(Az), 0.0) / diameter_sq;
  // What x^2 shares with 1 and x is taken out of it; <x y> = 0 by the choice of the line.
  const double free = x4 - line.n * line.spread * line.spread - x3 * x3 / (line.n * line.spread);
  const double parabola = free > 0 ? A(1, 1) - x2y * x2y / free : A(1, 1);
  return {A(1, 1), std::min(round, parabola)};
}

/// Where the sides [lo, i] and [i, hi] are straight and meet at point i: how much better two lines
/// explain the window than one (sum of squares, in variances); 0 elsewhere.
double RowFitter::crease(std::uint32_t lo, std::uint32_t i, std::uint32_t hi, RowEdge& edge) const {
  const Vector3f& p = rows_->points[i];
  if (!is_clear(lo, i, hi)) return 0;
  const Line a = line(lo, i + 1);
  const double a_variance = variance_at(a, p);
  if (!is_straight(a, a_variance)) return 0;
  const Line b = line(i, hi + 1);
  const double b_variance = variance_at(b, p);
  if (!is_straight(b, b_variance)) return 0;
  const double sine = cross(a.tangent, b.tangent);
  const double angle_variance = a.angle_variance(a_variance) + b.angle_variance(b_variance);
  const bool turns_back = a.tangent.dot(b.tangent) < 0;
  if (!turns_back && sine * sine < least_turn_sine_sq_) return 0;
  if (sine * sine < kTurnSigmas * kTurnSigmas * angle_variance) return 0;
  const Vector2d meeting = a.mean + cross(b.mean - a.mean, b.tangent) / sine * a.tangent;
  const Vector2d here = p.head<2>().cast<double>();
  const double spacing_sq = (rows_->points[i + 1] - rows_->points[i - 1]).squaredNorm() / 4.0;
  const double off_sq = (meeting - here).squaredNorm();
  if (off_sq > 0.0025 + 2.0 * spacing_sq) return 0;
  const double least_cosine_sq = kSideCosineSq * p.squaredNorm();
  const double a_along = a.normal().dot(here);
  const double b_along = b.normal().dot(here);
  if (std::min(a_along * a_along, b_along * b_along) < least_cosine_sq) return 0;
  const double sides = a.thickness * a.n + b.thickness * b.n;
  const Line whole = line(lo, hi + 1);
  const double variance = std::min(a_variance, b_variance);
  // A round column turns as well, but a curve explains it better than two straight sides do, and
  // its sides are bent themselves.
  if (bend(lo, hi + 1, whole).curve - sides < kCurveGain * variance) return 0;
  const Bend a_bent = bend(lo, i + 1, a), b_bent = bend(i, hi + 1, b);
  const double gain =
      (a_bent.line - a_bent.curve) / a_variance + (b_bent.line - b_bent.curve) / b_variance;
  if (gain > kBentSides) return 0;
  edge.at = i;
  const double grown = std::sqrt(meeting.squaredNorm() / here.squaredNorm());
  edge.position = {static_cast<float>(meeting.x()), static_cast<float>(meeting.y()),
                   static_cast<float>(p.z() * grown)};
  // The end of a fitted line is known to 4 / n of a point's variance.
  edge.sigma_m = static_cast<float>(std::sqrt(4.0 * a_variance / a.n + 4.0 * b_variance / b.n) /
                                    std::abs(sine));
  return (whole.thickness * whole.n - sides) / variance;
}

/// A straight face that ends in front of something farther ends in an edge. What is seen behind it
/// begins where the ray passes, so its end says nothing; neither does a missing return.
void RowFitter::add_border(const Segment& segment, bool at_end, std::vector<RowEdge>& edges) const {
  if (segment.end - segment.begin < least_side_ + 1) return;
  const std::uint32_t last = at_end ? segment.end - 1 : segment.begin;
  const Vector3f& p = rows_->points[last];
  std::uint32_t first = last;
  const std::uint32_t most = at_end ? last - segment.begin : segment.end - 1 - last;
  const auto inward = [&](std::uint32_t k) { return at_end ? last - k : last + k; };
  double length_sq = 0;
  std::uint32_t count = 0;
  while (count < most) {
    const double next = (rows_->points[inward(count + 1)] - p).squaredNorm();
    if (next > window_sq_) break;
    length_sq = next;
    first = inward(++count);
  }
  if (count < least_side_ || length_sq < 0.5 * window_sq_) return;
  const Line face = line(std::min(first, last), std::max(first, last) + 1);
  const double variance = variance_at(face, p);
  const double along = face.normal().dot(p.head<2>().cast<double>());
  if (along * along < kFaceCosineSq * p.squaredNorm() || !is_straight(face, variance)) return;
  const double off = face.normal().dot(p.head<2>().cast<double>() - face.mean);
  if (off * off > kOutlierSq * variance) return;
  const Bend bent = bend(std::min(first, last), std::max(first, last) + 1, face);
  if (bent.line - bent.curve > kCurveGain * variance) return;
  // The face ends somewhere before the next ray: half a spacing on, give or take its deviation.
  const float scale = static_cast<float>(face.normal().dot(face.mean) / along);
  const Vector2f out = (at_end ? face.tangent : -face.tangent).cast<float>();
  const float spacing = std::abs(out.dot((rows_->points[inward(1)] - p).head<2>()));
  Vector3f position = p * scale;
  position.head<2>() += 0.5F * spacing * out;
  const float quantised = kUniformSigma * spacing;
  edges.push_back({last, position,
                   std::hypot(static_cast<float>(2.0 * std::sqrt(variance / face.n)), quantised)});
}

void RowFitter::fit_segment(const Segment& segment, std::vector<WindowFit>& fits,
                            std::vector<RowEdge>& edges) {
  const auto& p = rows_->points;
  if (segment.before == Break::kNearerAfter) add_border(segment, false, edges);
  const std::size_t first_crease = edges.size();
  double best = 0;
  std::uint32_t lo = segment.begin, hi = segment.begin, last = segment.begin;
  for (std::uint32_t i = segment.begin; i < segment.end; ++i) {
    // Windows of neighbours are all but the same where points lie dense.
    if (i > last && (p[i] - p[last]).squaredNorm() < stride_sq_) continue;
    last = i;
    for (; lo < i; ++lo) {
      const double far = (p[lo] - p[i]).squaredNorm();
      if (far <= window_sq_ || (i - lo <= least_side_ && far <= widest_sq_)) break;
    }
    for (hi = std::max(hi, i); hi + 1 < segment.end; ++hi) {
      const double far = (p[hi + 1] - p[i]).squaredNorm();
      if (far > window_sq_ && (hi + 1 - i > least_side_ || far > widest_sq_)) break;
    }
    if (i - lo < least_side_ || hi - i < least_side_) continue;
    const Line whole = line(lo, hi + 1);
    const double variance = variance_at(whole, p[i]);
    if (is_straight(whole, variance)) {
      if (is_clear(lo, i, hi)) fit_window(i, whole, variance, fits[i]);
      continue;
    }
    // The tip of two sides is 1.7 times the RMS distance off the line through both.
    const double off = whole.normal().dot(p[i].head<2>().cast<double>() - whole.mean);
    if (off * off < kTipShare * whole.thickness) continue;
    RowEdge edge;
    const double gain = crease(lo, i, hi, edge);
    if (gain <= 0) continue;
    // Of neighbours that all see the same edge the one with the greatest gain stands for it.
    const bool same = edges.size() > first_crease &&
                      (edges.back().position - edge.position).squaredNorm() < 0.25 * window_sq_;
    if (same && gain <= best) continue;
    if (!same) edges.emplace_back();
    edges.back() = edge;
    best = gain;
  }
  if (segment.after == Break::kNearerBefore) add_border(segment, true, edges);
}

}  // namespace holdfast::features
