#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "holdfast/core/result.hpp"

namespace holdfast::benchmarks {

/// What a child process answered and what it took.
struct ChildOutcome {
  nlohmann::ordered_json answer;
  double peak_rss_mb = 0;  ///< largest resident set of the child, pages of mapped files included
  double cpu_s = 0;        ///< user and system time of all its threads
};

/// Forks, calls `work` in the child and hands its answer back. The child begins with the memory of
/// the caller, so the caller should hold little; it must have no other threads. Errors: what `work`
/// says, or how the child died.
Result<ChildOutcome> run_in_child(const std::function<Result<nlohmann::ordered_json>()>& work);

}  // namespace holdfast::benchmarks
