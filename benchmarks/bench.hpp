#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"

/// What `holdfast bench` measures. Benchmarks may use every module; no module uses them.
namespace holdfast::benchmarks {

/// Seeds from `first` to `last`, both included.
struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t last = 1;

  std::size_t count() const { return last - first + 1; }
};

/// Parses "A:B" (both included) or "A"; at most 1000 seeds.
Result<SeedRange> parse_seeds(const std::string& text);

/// Called with the share done, 0 to 1, and what is being done.
using Progress = std::function<void(double, const std::string&)>;

struct BenchOptions {
  SeedRange seeds;
  double duration_s = 20;  ///< of each simulated drive
  int threads = 1;
  std::vector<std::string> settings;   ///< module.key=value, over the configuration of each drive
  std::vector<std::string> scenarios;  ///< none: all of the bench
  std::filesystem::path out;           ///< where a long bench keeps what it has; empty: nowhere
  Progress progress = [](double, const std::string&) {};
};

/// What a bench found: `data` for machines, with stable keys (lengths in metres, times with the
/// unit in the key, null where nothing is known), `markdown` for people.
struct BenchReport {
  nlohmann::ordered_json data;
  std::string markdown;
};

/// An entry of the list of benches.
struct BenchInfo {
  std::string_view name;
  std::string_view summary;  ///< one line
  SeedRange seeds;           ///< what is taken when the command line says nothing
  double duration_s;
  Result<BenchReport> (*measure)(const BenchOptions&);
  bool takes_settings = false;   ///< runs the system as configured
  bool takes_scenarios = false;  ///< measures those that are asked for
};

/// All benches, in the order in which the help shows them.
std::span<const BenchInfo> benches();

/// The bench of that name. The error lists the known names.
Result<const BenchInfo*> find_bench(std::string_view name);

/// Measures, and adds to the result how it came about: command, seeds, CPU, compiler. Figures of
/// time are those of this machine at this moment; the errors of trajectories are the same on each
/// run. Settings that the bench does not take, or that are none, are errors.
Result<BenchReport> run_bench(const BenchInfo& bench, const BenchOptions& options);

/// Writes DIR/NAME.json and DIR/NAME.md; makes DIR.
Status write_report(const BenchInfo& bench, const BenchReport& report,
                    const std::filesystem::path& dir);

}  // namespace holdfast::benchmarks
