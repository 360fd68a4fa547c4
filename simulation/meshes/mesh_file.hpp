#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "holdfast/core/result.hpp"

namespace holdfast::simulation {

/// Triangles as a file holds them, in the file's own frame and unit.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads the triangles of a .ply or .obj file (by Assimp; polygons are cut into triangles,
/// triangles without an area, points and lines are left out). Errors name the file, what was
/// expected and what was found: no such file, another ending, unreadable, no faces, a coordinate
/// that is not finite or beyond 10 km, where float would lose millimetres.
Result<Mesh> read_mesh(const std::filesystem::path& path);

/// True when a .ply file declares faces in its header, and is therefore a mesh rather than a cloud.
/// False also when it cannot be read.
bool has_faces(const std::filesystem::path& ply);

}  // namespace holdfast::simulation
