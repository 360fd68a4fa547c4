#pragma once

#include <filesystem>
#include <string>

#include "holdfast/core/result.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {

/// A scenario as a file holds it: `name`, `world` (a list of parts, part_files.hpp), `route`
/// (`corners` as [x, y], [x, y, z] or [x, y, z, radius_m], and `radius_m` of those without one;
/// or `auto`: the way that find_route finds), and where they differ from the defaults `drive`
/// (DriveStyle), `people` and `vehicles` (each a `route` and a `speed_m_s`), `lifts` and `regions`.
/// Errors name file, line, key, what was expected and found.
Result<Scenario> read_scenario_file(const std::filesystem::path& path);

/// The same of a text that messages call `name`.
Result<Scenario> parse_scenario(const std::string& text, const std::string& name);

}  // namespace holdfast::simulation
