#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "holdfast/core/result.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

/// Builds a list of parts as a scenario file holds them: each entry is a name and its keys, as in
/// `- box: {center: [1, 2, 0.5], size: [1, 1, 1]}`. `file` is for messages. Errors name file, line,
/// key, what was expected and found, and for an unknown part all that are known.
Status build_parts(const YAML::Node& list, const std::string& file, WorldBuilder& build);

/// All parts with their keys, in Markdown.
std::string part_reference();

}  // namespace holdfast::simulation
