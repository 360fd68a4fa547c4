#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "simulation/world/material.hpp"

namespace holdfast::simulation {

/// The static world: triangles in the map frame (metres, z up). A triangle's front, from which its
/// corners run counter-clockwise, looks into free space; rays are stopped by both sides, a survey
/// sees the front only.
struct World {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material_of;  ///< index into materials, one a triangle
  std::vector<Material> materials;
};

}  // namespace holdfast::simulation
