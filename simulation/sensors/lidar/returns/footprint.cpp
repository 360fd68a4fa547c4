#include "simulation/sensors/lidar/returns/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3f;

constexpr int kRays = RayPacket::kSize;
constexpr float kStep = 0.05F;  // metres off the axis's plane: another surface

void set_ray(RayPacket& rays, int lane, const Vector3f& origin, const Vector3f& direction) {
  const auto k = static_cast<std::size_t>(lane);
  rays.x[k] = origin.x();
  rays.y[k] = origin.y();
  rays.z[k] = origin.z();
  rays.dx[k] = direction.x();
  rays.dy[k] = direction.y();
  rays.dz[k] = direction.z();
}

Vector3f direction_of(const RayPacket& rays, int lane) {
  const auto k = static_cast<std::size_t>(lane);
  return {rays.dx[k], rays.dy[k], rays.dz[k]};
}

/// The beam next to `i` in an earlier (-1) or later (+1) column; none at the ends of a frame.
const Echo* neighbour(const Beams& beams, std::size_t i, int way) {
  const std::size_t column = i / beams.per_column;
  const std::size_t beam = i % beams.per_column;
  if (way < 0) {
    if (column > 0) return &beams.echoes[i - beams.per_column];
    return beams.before.empty() ? nullptr : &beams.before[beam];
  }
  if (column + 1 < beams.columns()) return &beams.echoes[i + beams.per_column];
  return beams.after.empty() ? nullptr : &beams.after[beam];
}

}  // namespace

/// One of those that make up a beam.
struct Footprint::Ray {
  Echo echo;
  float power = 0;
};

Footprint::Footprint(const LidarModel& lidar)
    : edges_(lidar),
      radius_(static_cast<float>(lidar.divergence_rad / 2)),
      pulse_length_m_(static_cast<float>(lidar.pulse_length_m)),
      min_range_m_(static_cast<float>(lidar.min_range_m)),
      max_range_m_(static_cast<float>(lidar.max_range_m)),
      keep_last_(lidar.faults.kept_return == "last") {}

RayPacket Footprint::rays_of(const Beams& beams, std::size_t i, RandomStream& random) const {
  const Vector3f& axis = beams.direction[i];
  const Vector3f u = axis.unitOrthogonal();
  const Vector3f v = axis.cross(u);
  RayPacket rays;
  for (int k = 0; k < kRays; ++k) {
    const auto off = radius_ * static_cast<float>(std::sqrt(random.uniform()));
    const auto turn = static_cast<float>(2 * std::numbers::pi * random.uniform());
    const Vector3f direction = axis + off * (std::cos(turn) * u + std::sin(turn) * v);
    set_ray(rays, k, beams.origin[i], direction.normalized());
  }
  return rays;
}

/// The rays' echoes as the receiver tells them apart; one of them is kept.
Echo Footprint::merged(std::vector<Ray>& rays) const {
  std::sort(rays.begin(), rays.end(),
            [](const Ray& a, const Ray& b) { return a.echo.range < b.echo.range; });
  Echo kept;
  float most = 0;
  for (std::size_t first = 0, end = 0; first < rays.size(); first = end) {
    float power = 0;
    float moment = 0;
    std::size_t strongest = first;
    for (end = first; end < rays.size(); ++end) {
      const bool apart =
          end > first && rays[end].echo.range - rays[end - 1].echo.range > pulse_length_m_;
      if (apart) break;
      power += rays[end].power;
      moment += rays[end].power * rays[end].echo.range;
      if (rays[end].power > rays[strongest].power) strongest = end;
    }
    if (power <= 0 || (power <= most && !keep_last_)) continue;
    most = power;
    kept = rays[strongest].echo;
    kept.range = moment / power;
    kept.power = static_cast<float>(end - first) / kRays;
    kept.kind = ReturnKind::kMixed;
  }
  return kept;
}

void Footprint::look_into(Echo& echo, const Beams& beams, std::size_t i, const RayCaster& caster,
                          const Materials& materials, RandomStream& random) const {
  const RayPacket packet = rays_of(beams, i, random);
  HitPacket hits;
  caster.cast(packet, min_range_m_, max_range_m_, hits);
  const Vector3f& normal = caster.normal(beams.triangle[i]);
  const float height = echo.range * normal.dot(beams.direction[i]);
  std::vector<Ray> rays;
  bool one_surface = echo.is_there();
  for (std::size_t k = 0; k < kRays; ++k) {
    Ray ray{{hits.range[k], hits.cos_incidence[k], 1, hits.material[k], ReturnKind::kMixed}, 0};
    if (!ray.echo.is_there()) continue;
    const float expected = height / normal.dot(direction_of(packet, static_cast<int>(k)));
    one_surface = one_surface && std::abs(ray.echo.range - expected) < kStep;
    rays.push_back(ray);
  }
  if (one_surface) {
    echo.power = static_cast<float>(rays.size()) / kRays;
    return;
  }
  for (Ray& ray : rays) {
    const auto speckle = static_cast<float>(-std::log(1 - random.uniform()));
    const auto reflectivity = static_cast<float>(materials[ray.echo.material].reflectivity);
    ray.power = speckle * reflectivity * ray.echo.cos_incidence / (ray.echo.range * ray.echo.range);
  }
  echo = merged(rays);
}

/// What moves is not in the ray caster's world. Its silhouette lies somewhere between two columns,
/// equally likely everywhere, so that it falls into the half of the beam on that side as often as
/// that half is wide against the columns' step.
void Footprint::blur_silhouette(Echo& echo, const Beams& beams, std::size_t i,
                                const Materials& materials, RandomStream& random) const {
  for (const int way : {-1, 1}) {
    const Echo* other = neighbour(beams, i, way);
    if (other == nullptr || !other->is_there() || !echo.is_there()) continue;
    if (materials.moves(other->material) == materials.moves(echo.material)) continue;
    const double chance = radius_ / edges_.column_step_rad();
    const double drawn = random.uniform();
    const float gap = other->range - echo.range;
    if (drawn >= chance || std::abs(gap) > pulse_length_m_) continue;
    const double share = 0.5 * drawn / chance;  // of the beam beyond the silhouette
    echo.range += static_cast<float>(share) * gap;
    echo.kind = ReturnKind::kMixed;
    return;
  }
}

void Footprint::look(Beams& beams, const RayCaster& caster, const Materials& materials,
                     RandomStream& random) const {
  const std::vector<std::size_t> at_edges = edges_.find(beams);
  std::vector<Echo> seen;
  seen.reserve(at_edges.size());
  for (const std::size_t i : at_edges) {
    Echo echo = beams.echoes[i];
    const bool moves = echo.is_there() && materials.moves(echo.material);
    if (!moves) look_into(echo, beams, i, caster, materials, random);
    if (echo.kind == ReturnKind::kSurface) {
      blur_silhouette(echo, beams, i, materials, random);
    }
    seen.push_back(echo);
  }
  for (std::size_t k = 0; k < seen.size(); ++k) beams.echoes[at_edges[k]] = seen[k];
}

}  // namespace holdfast::simulation
