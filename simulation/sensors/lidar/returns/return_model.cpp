#include "simulation/sensors/lidar/returns/return_model.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::simulation {

std::optional<ReturnModel> ReturnModel::create(const LidarModel& lidar, const Weather& weather) {
  if (lidar.faults.none() && weather.is_clear()) return std::nullopt;
  return ReturnModel(lidar, weather);
}

ReturnModel::ReturnModel(const LidarModel& lidar, const Weather& weather)
    : lidar_(lidar),
      air_(weather),
      budget_(lidar.reach_at_10_percent_m, air_.extinction()),
      footprint_(lidar),
      mirrors_(lidar) {}

std::vector<char> ReturnModel::returned_by_material(const Beams& beams, const Materials& materials,
                                                    RandomStream random) const {
  std::vector<char> returned(beams.echoes.size(), 0);
  for (std::size_t i = 0; i < beams.echoes.size(); ++i) {
    // Drawn for every ray, so that what one ray meets does not change what becomes of the others.
    const double chance = random.uniform();
    const Echo& echo = beams.echoes[i];
    if (!echo.is_there()) continue;
    const Material& material = materials[echo.material];
    const bool returns = chance < material.return_probability(echo.cos_incidence);
    returned[i] = returns || lidar_.keep_all_returns ? 1 : 0;
  }
  return returned;
}

void ReturnModel::lose_weak(Beams& beams, const Materials& materials, RandomStream random) const {
  for (Echo& echo : beams.echoes) {
    const double chance = random.uniform();
    if (!echo.is_there()) continue;
    const double share = materials[echo.material].reflectivity * echo.power * echo.cos_incidence;
    const double strength = budget_.strength(share, echo.range);
    if (chance >= LinkBudget::seen_probability(strength)) echo = Echo();
  }
}

void ReturnModel::lose_some(Beams& beams, RandomStream random) const {
  for (Echo& echo : beams.echoes) {
    if (random.uniform() < lidar_.faults.dropout_share) echo = Echo();
  }
}

void ReturnModel::meet_air(Beams& beams, const std::vector<float>& free_m,
                           RandomStream random) const {
  for (std::size_t i = 0; i < beams.echoes.size(); ++i) {
    const double depth = -std::log(1 - random.uniform());
    const double free = std::min<double>(free_m[i], lidar_.max_range_m);
    const double range = air_.first_echo(lidar_.min_range_m, free, depth);
    if (!std::isfinite(range)) continue;
    beams.echoes[i] = Echo{static_cast<float>(range), 1, 0, 0, ReturnKind::kAir};
  }
}

double ReturnModel::brightness(const Echo& echo, const Materials& materials) {
  constexpr double kDrop = 0.02;
  if (echo.kind == ReturnKind::kAir) return kDrop;
  const double mirrored = echo.kind == ReturnKind::kGhost ? echo.power : 1;
  return materials[echo.material].reflectivity * echo.cos_incidence * mirrored;
}

void ReturnModel::spoil(Beams& beams, const RayCaster& caster, const Materials& materials,
                        const StreamMaker& stream) const {
  const LidarFaults& faults = lidar_.faults;
  std::vector<float> free_m;
  if (!air_.is_clear()) {
    for (const Echo& echo : beams.echoes) free_m.push_back(echo.range);
  }
  if (faults.mixed_pixels) {
    RandomStream random = stream("lidar.footprint");
    footprint_.look(beams, caster, materials, random);
  }
  auto returned = returned_by_material(beams, materials, stream("lidar.return"));
  if (faults.ghost_share > 0 || faults.multipath_share > 0) {
    RandomStream random = stream("lidar.mirror");
    mirrors_.throw_on(beams, returned, caster, materials, random);
  }
  for (std::size_t i = 0; i < returned.size(); ++i) {
    if (returned[i] == 0) beams.echoes[i] = Echo();
  }
  if (faults.limited_reach || !air_.is_clear()) lose_weak(beams, materials, stream("lidar.reach"));
  if (faults.dropout_share > 0) lose_some(beams, stream("lidar.dropout"));
  if (!air_.is_clear()) meet_air(beams, free_m, stream("lidar.air"));
}

}  // namespace holdfast::simulation
