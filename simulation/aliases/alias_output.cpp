#include "simulation/aliases/alias_output.hpp"

#include "holdfast/io/atomic_output.hpp"

namespace holdfast::simulation {

Result<AliasSummary> write_aliases(const Simulation& simulation, const AliasModel& model,
                                   const std::filesystem::path& folder) {
  AliasSummary summary;
  std::string text;
  for (const AliasedStretch& stretch : find_aliases(simulation, model)) {
    text += alias_json(stretch) + "\n";
    summary.aliased_s += to_seconds(stretch.t1 - stretch.t0);
    ++summary.stretches;
  }
  const Status written = io::write_file_atomically(folder / "aliases.jsonl", text);
  if (!written) return written.error();
  return summary;
}

}  // namespace holdfast::simulation
