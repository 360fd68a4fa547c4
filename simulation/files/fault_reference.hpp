#pragma once

#include <string>

namespace holdfast::simulation {

/// What clocks, losses, extrinsics, wheels and satellites do in a simulated log, in Markdown, with
/// the sizes that the models have.
std::string fault_reference();

}  // namespace holdfast::simulation
