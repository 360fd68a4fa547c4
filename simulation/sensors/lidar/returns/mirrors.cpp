#include "simulation/sensors/lidar/returns/mirrors.hpp"

#include <algorithm>

namespace holdfast::simulation {

using Eigen::Vector3f;

/// A beam that goes on.
struct Mirrors::Thrown {
  std::size_t beam;
  bool is_ghost;  ///< or multipath
  float chance;   ///< drawn for the second surface
};

namespace {

constexpr float kOff = 1e-3F;  // metres from the first surface, which is not met again

void set_ray(RayPacket& rays, std::size_t lane, const Vector3f& origin, const Vector3f& way) {
  rays.x[lane] = origin.x();
  rays.y[lane] = origin.y();
  rays.z[lane] = origin.z();
  rays.dx[lane] = way.x();
  rays.dy[lane] = way.y();
  rays.dz[lane] = way.z();
}

/// What a beam that was mirrored once comes back with, having met `second` behind `first`.
Echo ghost(const Echo& first, const Echo& second, const Materials& materials) {
  const auto mirrored = static_cast<float>(materials[first.material].mirror_return);
  Echo echo = second;
  echo.range += first.range;
  echo.power = first.power * mirrored * mirrored;
  echo.kind = ReturnKind::kGhost;
  return echo;
}

/// Half of the way by a second face in a corner.
void lengthen(Echo& first, const Echo& second, const Vector3f& from, const Vector3f& way,
              const Vector3f& lidar) {
  if (second.range > Mirrors::kCorner) return;
  const Vector3f met = from + (second.range - kOff) * way;
  first.range = 0.5F * (first.range + second.range + (met - lidar).norm());
  first.kind = ReturnKind::kMultipath;
}

}  // namespace

Mirrors::Mirrors(const LidarModel& lidar)
    : faults_(lidar.faults), max_range_m_(static_cast<float>(lidar.max_range_m)) {}

std::vector<Mirrors::Thrown> Mirrors::thrown(const Beams& beams, const std::vector<char>& returned,
                                             const Materials& materials,
                                             RandomStream& random) const {
  std::vector<Thrown> out;
  for (std::size_t i = 0; i < beams.echoes.size(); ++i) {
    // Drawn for every beam, so that what one meets does not change what becomes of the others.
    const double drawn = random.uniform();
    const auto second = static_cast<float>(random.uniform());
    const Echo& echo = beams.echoes[i];
    if (echo.kind != ReturnKind::kSurface || !echo.is_there() || materials.moves(echo.material)) {
      continue;
    }
    const double mirrored = materials[echo.material].mirror_return;
    const bool is_ghost = returned[i] == 0 && drawn < faults_.ghost_share * mirrored;
    const bool is_multipath = returned[i] != 0 && mirrored == 0 && drawn < faults_.multipath_share;
    if (!is_ghost && !is_multipath) continue;
    out.push_back({i, is_ghost, second});
  }
  return out;
}

RayPacket Mirrors::packet_of(const Beams& beams, const std::vector<Thrown>& thrown,
                             std::size_t first, const RayCaster& caster) {
  RayPacket rays;
  for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
    const std::size_t i = thrown[std::min(first + lane, thrown.size() - 1)].beam;
    const Vector3f& d = beams.direction[i];
    const Vector3f& normal = caster.normal(beams.triangle[i]);
    const Vector3f way = d - 2 * normal.dot(d) * normal;
    set_ray(rays, lane, beams.origin[i] + beams.echoes[i].range * d + kOff * way, way);
  }
  return rays;
}

void Mirrors::throw_on(Beams& beams, std::vector<char>& returned, const RayCaster& caster,
                       const Materials& materials, RandomStream& random) const {
  const std::vector<Thrown> all = thrown(beams, returned, materials, random);
  HitPacket hits;
  for (std::size_t first = 0; first < all.size(); first += RayPacket::kSize) {
    const RayPacket rays = packet_of(beams, all, first, caster);
    caster.cast(rays, 0, max_range_m_, hits);
    for (std::size_t lane = 0; lane < RayPacket::kSize && first + lane < all.size(); ++lane) {
      const Thrown& thrown = all[first + lane];
      Echo& echo = beams.echoes[thrown.beam];
      const Echo second{hits.range[lane] + kOff, hits.cos_incidence[lane], 1, hits.material[lane],
                        ReturnKind::kSurface};
      if (!second.is_there()) continue;
      if (!thrown.is_ghost) {
        lengthen(echo, second, {rays.x[lane], rays.y[lane], rays.z[lane]},
                 {rays.dx[lane], rays.dy[lane], rays.dz[lane]}, beams.origin[thrown.beam]);
        continue;
      }
      const double chance = materials[second.material].return_probability(second.cos_incidence);
      if (thrown.chance >= chance || echo.range + second.range > max_range_m_) continue;
      echo = ghost(echo, second, materials);
      returned[thrown.beam] = 1;
    }
  }
}

}  // namespace holdfast::simulation
