#pragma once

#include <filesystem>

#include "simulation/aliases/aliases.hpp"

namespace holdfast::simulation {

/// What was written.
struct AliasSummary {
  double aliased_s = 0;
  std::size_t stretches = 0;
};

/// Finds the aliases of a drive and writes FOLDER/aliases.jsonl, one line a stretch, whole or not
/// at all; an empty file when every place is unlike all others.
Result<AliasSummary> write_aliases(const Simulation& simulation, const AliasModel& model,
                                   const std::filesystem::path& folder);

}  // namespace holdfast::simulation
