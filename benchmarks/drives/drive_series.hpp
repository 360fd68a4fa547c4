#pragma once

#include <fmt/format.h>

#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "benchmarks/bench.hpp"
#include "benchmarks/drives/surveyed_drive.hpp"

namespace holdfast::benchmarks {

/// A drive of a series; what a bench keeps of it derives from this.
struct SeriesDrive {
  const char* scenario = nullptr;
  std::uint64_t seed = 0;
  std::string failure;  ///< why there is no result; empty where there is one
};

/// The drives of one scenario, in the order of their seeds.
template <class Drive>
struct DrivesOfScenario {
  const char* scenario = nullptr;
  std::vector<Drive> drives;
};

/// Measures a drive for each scenario and each seed, `options.threads` at a time, each on one
/// thread: `measure(spec, drive)` is a Status, and what it says is the drive's failure. The result
/// stands in the order of scenarios and seeds, whichever thread was first.
template <class Drive, class Measure>
std::vector<DrivesOfScenario<Drive>> measure_series(std::span<const char* const> scenarios,
                                                    const BenchOptions& options,
                                                    const Measure& measure) {
  std::vector<DrivesOfScenario<Drive>> series;
  for (const char* scenario : scenarios) {
    auto& drives = series.emplace_back(scenario, std::vector<Drive>()).drives;
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      Drive& drive = drives.emplace_back();
      drive.scenario = scenario;
      drive.seed = seed;
    }
  }
  const std::size_t of_each = options.seeds.count();
  const std::size_t all = of_each * series.size();
  WorkerPool pool(options.threads);
  std::mutex mutex;
  std::size_t done = 0;
  pool.run(all, [&](std::size_t i) {
    Drive& drive = series[i / of_each].drives[i % of_each];
    const DriveSpec spec{drive.scenario, drive.seed, options.duration_s, 1, options.settings};
    if (const Status status = measure(spec, drive); !status) {
      drive.failure = status.error().message;
    }
    const std::lock_guard lock(mutex);
    options.progress(static_cast<double>(++done) / static_cast<double>(all),
                     fmt::format("{}, seed {}", drive.scenario, drive.seed));
  });
  return series;
}

}  // namespace holdfast::benchmarks
