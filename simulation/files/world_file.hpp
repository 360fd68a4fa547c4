#pragma once

#include <filesystem>

#include "holdfast/core/result.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {

/// True when a name ends as a world in a file does: .pcd, .ply or .obj.
bool is_world_file(const std::filesystem::path& path);

/// A cloud or a mesh as a scenario: its world as `- cloud:` or `- mesh:` with their defaults make
/// it (a .ply with faces is a mesh), and the way that find_route finds. Errors name the file.
Result<Scenario> read_world_file(const std::filesystem::path& path);

/// Gives a scenario the way that find_route finds, a drive of at most 300 m along it, and a remark
/// that says how long it is. Error: there is none.
Status find_way(Scenario& scenario);

}  // namespace holdfast::simulation
