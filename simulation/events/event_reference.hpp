#pragma once

#include <string>

namespace holdfast::simulation {

/// What each event of `holdfast simulate --event` does, as a Markdown section.
std::string event_reference();

}  // namespace holdfast::simulation
