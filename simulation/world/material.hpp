#pragma once

namespace holdfast::simulation {

/// How a surface answers a laser pulse. With theta the angle between the ray and the normal:
///   P(return) = min(1, diffuse_return * min(1, cos(theta) / grazing_cos)
///                      + mirror_return * exp(-2 (1 - cos(theta)) / mirror_lobe_rad^2)).
struct Material {
  const char* name = "ideal";
  double reflectivity = 0.5;     ///< share of the light scattered back; scales the intensity
  double diffuse_return = 1.0;   ///< probability of a return from scattering
  double grazing_cos = 0.0;      ///< below this cosine scattering returns fade out; 0: never
  double mirror_return = 0.0;    ///< further probability when the surface faces the sensor
  double mirror_lobe_rad = 0.1;  ///< how squarely it has to face it
  double survey_return = 1.0;    ///< share of this surface that a survey brings back

  double return_probability(double cos_incidence) const;
};

/// Surfaces that the scenarios are made of.
namespace materials {

inline constexpr Material kIdeal{};
inline constexpr Material kPlaster{"plaster", 0.7, 1.0, 0.02};
inline constexpr Material kConcrete{"concrete", 0.4, 1.0, 0.02};
inline constexpr Material kBrick{"brick", 0.35, 1.0, 0.02};
inline constexpr Material kAsphalt{"asphalt", 0.15, 1.0, 0.02};
inline constexpr Material kGrass{"grass", 0.45, 0.97, 0.01};
inline constexpr Material kFoliage{"foliage", 0.5, 0.85, 0.0, 0.0, 0.1, 0.85};
inline constexpr Material kLinoleum{"linoleum", 0.3, 1.0, 0.03};
inline constexpr Material kCarpet{"carpet", 0.25, 1.0, 0.02};
inline constexpr Material kCeilingTile{"ceiling tile", 0.75, 1.0, 0.02};
inline constexpr Material kWood{"wood", 0.5, 1.0, 0.02};
inline constexpr Material kFabric{"fabric", 0.4, 1.0, 0.01};
inline constexpr Material kCardboard{"cardboard", 0.45, 1.0, 0.02};
inline constexpr Material kPaintedMetal{"painted metal", 0.6, 0.98, 0.04};
inline constexpr Material kAluminium{"aluminium", 0.6, 0.75, 0.1, 0.2, 0.15};
inline constexpr Material kClothing{"clothing", 0.3, 1.0, 0.0};
inline constexpr Material kGlass{"glass", 0.9, 0.012, 0.1, 0.9, 0.06, 0.04};
inline constexpr Material kPolishedStone{"polished stone", 0.2, 0.07, 0.25, 0.6, 0.2, 0.6};
// Clean, without frames or print: next to nothing is scattered, and what is mirrored keeps within a
// degree and a half.
inline constexpr Material kClearGlass{"clear glass", 0.9, 0.002, 0.1, 0.9, 0.025, 0.02};
inline constexpr Material kMirrorStone{"mirror stone", 0.2, 0.01, 0.25, 0.6, 0.1, 0.6};
inline constexpr Material kMirrorSteel{"mirror steel", 0.7, 0.04, 0.1, 0.9, 0.08, 0.5};

}  // namespace materials

}  // namespace holdfast::simulation
