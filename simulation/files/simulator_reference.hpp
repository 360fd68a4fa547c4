#pragma once

#include <string>

namespace holdfast::simulation {

/// How to write worlds and sensors as files, and what can go wrong in a drive: all keys with their
/// defaults and ranges, in Markdown.
std::string simulator_reference();

}  // namespace holdfast::simulation
