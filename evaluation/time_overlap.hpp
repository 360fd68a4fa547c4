#pragma once

#include <optional>

#include "evaluation/evaluate.hpp"
#include "evaluation/truth_track.hpp"

namespace holdfast::evaluation {

/// Why an estimate cannot be judged against a truth: one of them is empty, they do not overlap in
/// time, or the truth has gaps wherever there is a claim. None if it can.
std::optional<Error> find_time_problem(const Trajectory& estimate, const TruthTrack& truth,
                                       const RunContext& context);

/// read_tum, with a hint when the first stamp looks like another unit than seconds.
Result<Trajectory> read_trajectory(const std::filesystem::path& path);

}  // namespace holdfast::evaluation
