#include "holdfast/places/rendering/usual_rates.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "holdfast/registration/degeneracy.hpp"

namespace holdfast::places {
namespace {

using Eigen::Vector3f;

Vector3f direction_of(float elevation_deg, float azimuth_deg) {
  constexpr float kRadPerDeg = std::numbers::pi_v<float> / 180;
  const float e = elevation_deg * kRadPerDeg;
  const float a = azimuth_deg * kRadPerDeg;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

std::vector<Vector3f> directions_of(const ViewOptions& options) {
  std::vector<Vector3f> directions;
  const float step =
      (options.highest_deg - options.lowest_deg) / static_cast<float>(options.beams - 1);
  for (int column = 0; column < options.columns; ++column) {
    for (int beam = 0; beam < options.beams; ++beam) {
      directions.push_back(
          direction_of(options.lowest_deg + step * static_cast<float>(beam),
                       360.0F * static_cast<float>(column) / static_cast<float>(options.columns)));
    }
  }
  return directions;
}

/// A point of the map nearer to the surface that it was measured on: the noise of the survey is
/// taken off its distance to the plane, and what the surface itself is off the plane is left.
Vector3f without_noise(const map::PriorMap& map, const Vector3f& p) {
  constexpr float kSigmas = 3.0F;  // farther points are not of the plane
  const auto noise = static_cast<float>(map.info().noise_m);
  const auto found = map.find(0, p);
  Vector3f best = p;
  float least = std::numeric_limits<float>::infinity();
  for (const map::Surface* s = found.surface; s != nullptr; s = s->more != 0 ? s + 1 : nullptr) {
    if (s->kind != map::SurfaceKind::kPlane) continue;
    const float distance = s->normal.dot(p - found.corner - s->center);
    if (std::abs(distance) > std::min(least, kSigmas * s->sigma_m)) continue;
    least = std::abs(distance);
    const float left = 1.0F - noise * noise / (s->sigma_m * s->sigma_m);
    best = p - (1.0F - std::sqrt(std::max(left, 0.0F))) * distance * s->normal;
  }
  return best;
}

float share(double part, double whole) {
  return whole > 0 ? static_cast<float>(part / whole) : 0.0F;
}

}  // namespace

View::View(const VoxelWindow& window, const map::PriorMap& map, const ViewOptions& options)
    : window_(window),
      map_(map),
      options_(options),
      touch_m_(options.touch_spacings * static_cast<float>(map.info().spacing_m)),
      directions_(directions_of(options)) {}

std::optional<Place> View::from(const Vector3f& position, std::int32_t ix, std::int32_t iy,
                                std::uint64_t seed) {
  ix_ = ix;
  iy_ = iy;
  const Eigen::Vector3d in_map = position.cast<double>() + map_.info().origin;
  eye_ = (in_map - map_.anchor()).cast<float>();
  if (!is_enclosed()) return std::nullopt;
  render(seed);
  if (seen_.size() == 0) return std::nullopt;
  Place place{};
  place.position = position;
  place.hit_share =
      share(static_cast<double>(seen_.size()), static_cast<double>(directions_.size()));
  judge(place);
  follow(place);
  return place;
}

bool View::is_enclosed() const {
  constexpr int kLevelRays = 90;
  int hits = 0;
  for (int i = 0; i < kLevelRays; ++i) {
    const Ray ray{eye_, direction_of(0, 360.0F * (static_cast<float>(i) + 0.5F) / kLevelRays)};
    hits +=
        window_.first_hit(ix_, iy_, map_, ray, options_.enclosed_m, touch_m_).has_value() ? 1 : 0;
  }
  return static_cast<float>(hits) >= options_.enclosed_share * kLevelRays;
}

/// What the rays hit: real points of the map, with the LiDAR's noise in place of the survey's.
void View::render(std::uint64_t seed) {
  RandomStream noise(seed, "places");
  seen_.points.clear();
  for (const Vector3f& direction : directions_) {
    const auto hit =
        window_.first_hit(ix_, iy_, map_, {eye_, direction}, options_.reach_m, touch_m_);
    if (!hit) continue;
    const Vector3f way = without_noise(map_, *hit) - eye_;
    const float range = way.norm();
    if (range < options_.nearest_m) continue;
    const auto error = static_cast<float>(noise.normal(0.0, options_.association.range_sigma_m));
    seen_.points.push_back((range + error) / range * way);
  }
  seen_.age_s.assign(seen_.points.size(), 0.0F);
}

void View::judge(Place& place) {
  const SE3 T_anchor_eye{Eigen::Quaterniond::Identity(), eye_.cast<double>()};
  registration::associate(map_, T_anchor_eye, Eigen::Vector3d::Zero(), seen_, options_.association,
                          alone_, pairs_);
  const auto equations =
      registration::linearise(pairs_, T_anchor_eye, options_.robust_scale, alone_, partials_);
  place.agreeing_share = share(equations.weight, static_cast<double>(seen_.size()));
  const Eigen::Matrix3d feigned = registration::feigned_information(
      equations, pairs_, T_anchor_eye, options_.robust_scale, options_.few_pairs);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      registration::position_information(equations.H) - feigned);
  constexpr double kLeast = 1.0 / (double{kUnknownSigmaM} * kUnknownSigmaM);
  place.weakest_sigma_m =
      static_cast<float>(1.0 / std::sqrt(std::max(solver.eigenvalues()[0], kLeast)));
  place.weakest = solver.eigenvectors().col(0).cast<float>();
}

void View::follow(Place& place) const {
  std::vector<monitor::SightLine> lines;
  for (std::size_t i = 0; i < seen_.size();
       i += static_cast<std::size_t>(options_.lines_of_sight)) {
    lines.push_back({eye_, eye_ + seen_.points[i]});
  }
  const monitor::SightCounts counts = monitor::follow(map_, lines, options_.sight);
  place.through_share = share(counts.through, counts.lines);
  place.in_front_share = share(counts.in_front, counts.lines);
  place.unmapped_share = share(counts.unmapped, counts.lines);
}

}  // namespace holdfast::places
