#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/world/material.hpp"

namespace holdfast::simulation {

/// A thing in a world that people carry about: it may stand elsewhere, be gone or be new after a
/// survey.
struct WorldObject {
  std::string name;
  bool mounted = false;  ///< hangs on a wall or lies in a rack: comes and goes but does not wander
  bool spare = false;    ///< not there at first: it may come, nothing else
};

/// A small flat piece of a surface that is known by points only: a disc about a point. Both sides
/// stop rays, and a survey sees both.
struct Disc {
  Eigen::Vector3f center;
  float radius = 0;        ///< metres
  Eigen::Vector3f normal;  ///< unit length
  std::uint16_t material = 0;
};

/// The static world: triangles in the map frame (metres, z up). A triangle's front, from which its
/// corners run counter-clockwise, looks into free space; rays are stopped by both sides, a survey
/// sees the front only.
struct World {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material_of;  ///< index into materials, one a triangle
  std::vector<Material> materials;
  std::vector<WorldObject> objects;
  std::vector<std::uint16_t> object_of;  ///< one a triangle: 0 structure, k the object k - 1
  std::vector<Disc> discs;               ///< beside the triangles; never part of an object

  bool is_empty() const { return triangles.empty() && discs.empty(); }
};

}  // namespace holdfast::simulation
