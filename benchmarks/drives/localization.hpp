#pragma once

#include <optional>
#include <vector>

#include "benchmarks/drives/surveyed_drive.hpp"
#include "evaluation/evaluate.hpp"
#include "holdfast/core/step_report.hpp"

namespace holdfast::benchmarks {

/// Localizes `source` as `holdfast localize` does, without writing files. No initial pose: the map
/// is searched for it.
Result<std::vector<StepReport>> localize(SensorSource& source, const pipeline::Config& config,
                                         const std::filesystem::path& map_dir,
                                         const std::optional<SE3>& initial_pose);

/// The claims of a run.
evaluation::Trajectory claims_of(const std::vector<StepReport>& steps);

/// Judges a run as `holdfast evaluate` does, statuses and weak directions included.
Result<evaluation::Evaluation> judge(const std::vector<StepReport>& steps,
                                     const evaluation::Trajectory& truth);

}  // namespace holdfast::benchmarks
