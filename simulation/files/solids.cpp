#include "simulation/files/solids.hpp"

#include <array>

namespace holdfast::simulation {

Material material_of(const std::string& name) {
  static constexpr std::array kAll = {
      materials::kIdeal,       materials::kPlaster,      materials::kConcrete,
      materials::kBrick,       materials::kAsphalt,      materials::kGrass,
      materials::kFoliage,     materials::kLinoleum,     materials::kCarpet,
      materials::kCeilingTile, materials::kWood,         materials::kFabric,
      materials::kCardboard,   materials::kPaintedMetal, materials::kAluminium,
      materials::kClothing,    materials::kGlass,        materials::kPolishedStone,
      materials::kClearGlass,  materials::kMirrorStone,  materials::kMirrorSteel};
  for (const Material& material : kAll) {
    if (name == material.name) return material;
  }
  return materials::kIdeal;
}

void RampPart::add_to(WorldBuilder& build) const {
  const Material surface = material_of(material);
  const Eigen::Vector3d along = to - from;
  const Eigen::Vector3d left = 0.5 * width * Eigen::Vector3d(-along.y(), along.x(), 0).normalized();
  const Eigen::Vector3d down(0, 0, -thickness);
  build.quad(from - left, to - left, to + left, from + left, surface);
  build.quad(from + left + down, to + left + down, to - left + down, from - left + down, surface);
  build.quad(from - left + down, to - left + down, to - left, from - left, surface);
  build.quad(to + left + down, from + left + down, from + left, to + left, surface);
}

}  // namespace holdfast::simulation
