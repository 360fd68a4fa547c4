#include "benchmarks/bench.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <fstream>
#include <thread>

#include "benchmarks/benches/all.hpp"
#include "holdfast/io/atomic_output.hpp"
#include "holdfast/pipeline/config.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr std::array<BenchInfo, 14> kBenches = {{
    {"step",
     "time of a step, beside a k-d-tree registration and plain reading of the log",
     {1, 1},
     60,
     measure_step},
    {"accuracy",
     "errors over worlds and seeds in surveyed maps",
     {1, 10},
     60,
     measure_accuracy,
     true},
    {"scenarios",
     "all scenarios, as they are, changed, and with each event; a stopped run goes on",
     {1, 3},
     60,
     measure_scenarios,
     true,
     true},
    {"detection",
     "missed events, time to alarm and false alarms of the monitor and of the article's detector",
     {1, 10},
     30,
     measure_detection,
     true,
     true},
    {"relocalization",
     "kidnaps and starts without a pose: made up for in 3 s, how soon, wrong poses taken over",
     {1, 7},
     60,
     measure_relocalization,
     true,
     true},
    {"search",
     "the global search alone: found right, wrong or not at all, time and work",
     {1, 3},
     60,
     measure_search,
     true,
     true},
    {"regions",
     "errors by region of the campus, over its whole way in one drive",
     {1, 1},
     10000,
     measure_regions,
     true},
    {"import",
     "time and memory of making and using a map of 2 million points",
     {1, 1},
     20,
     measure_import},
    {"simulator", "speed of the simulator, in process and to a bag", {1, 1}, 20, measure_simulator},
    {"features",
     "edges and planes of scans: counts, precision, recall, time; matches, returns, occlusion",
     {1, 1},
     10,
     measure_features,
     false,
     true},
    {"deskew",
     "distance of points from their surfaces, raw and deskewed, on straights and in turns",
     {1, 5},
     60,
     measure_deskew},
    {"odometry",
     "drift, consistency, time and memory of the odometry alone",
     {1, 5},
     60,
     measure_odometry,
     true},
    {"consistency",
     "errors of the localizer by the covariance that it reports",
     {101, 105},
     30,
     measure_consistency,
     true},
    {"ablation",
     "errors of the whole system and of it without one part at a time",
     {1, 3},
     30,
     measure_ablation,
     true},
}};

constexpr std::uint64_t kMostSeeds = 1000;

/// A whole number that fills the text.
bool parse_number(std::string_view text, std::uint64_t& number) {
  const auto* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

/// The command line that gives this result, whatever was left to defaults.
std::string command_of(const BenchInfo& bench, const BenchOptions& options) {
  std::string command = fmt::format(
      "holdfast bench {} --out DIR --seeds {}:{} --duration {} --threads {}", bench.name,
      options.seeds.first, options.seeds.last, options.duration_s, options.threads);
  for (const std::string& scenario : options.scenarios) {
    command += fmt::format(" --scenario {}", scenario);
  }
  for (const std::string& setting : options.settings) {
    command += fmt::format(" --set \"{}\"", setting);
  }
  return command;
}

nlohmann::ordered_json origin_of(const BenchInfo& bench, const BenchOptions& options) {
  nlohmann::ordered_json j;
  j["bench"] = bench.name;
  j["command"] = command_of(bench, options);
  j["seeds"] = {options.seeds.first, options.seeds.last};
  j["duration_s"] = options.duration_s;
  j["threads"] = options.threads;
  j["cpu"] = cpu_model();
  j["cores"] = std::thread::hardware_concurrency();
  j["compiler"] = __VERSION__;
#ifdef NDEBUG
  j["assertions"] = false;
#else
  j["assertions"] = true;
#endif
  return j;
}

/// Before the first drive, not as the failure of each.
Status check_settings(const BenchInfo& bench, const BenchOptions& options) {
  if (!options.settings.empty() && !bench.takes_settings) {
    return Error{fmt::format("bench {} takes no --set", bench.name)};
  }
  if (!options.scenarios.empty() && !bench.takes_scenarios) {
    return Error{fmt::format("bench {} takes no --scenario", bench.name)};
  }
  pipeline::Config config;
  auto fields = pipeline::fields_of(config);
  for (const std::string& setting : options.settings) {
    if (auto set = io::set_field(setting, fields); !set) return set;
  }
  return Done{};
}

}  // namespace

std::span<const BenchInfo> benches() { return kBenches; }

Result<const BenchInfo*> find_bench(std::string_view name) {
  std::string known;
  for (const BenchInfo& bench : kBenches) {
    if (bench.name == name) return &bench;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", bench.name);
  }
  return Error{fmt::format("unknown bench '{}'; known are: {}", name, known)};
}

Result<SeedRange> parse_seeds(const std::string& text) {
  const auto colon = text.find(':');
  const std::string_view whole = text;
  SeedRange seeds;
  const bool read =
      parse_number(whole.substr(0, colon), seeds.first) &&
      parse_number(whole.substr(colon == std::string::npos ? 0 : colon + 1), seeds.last);
  if (!read) return Error{fmt::format("seeds '{}': expected A:B, as in 1:10", text)};
  if (seeds.last < seeds.first || seeds.last - seeds.first >= kMostSeeds) {
    return Error{fmt::format("seeds '{}': expected A <= B and at most {} seeds", text, kMostSeeds)};
  }
  return seeds;
}

Result<BenchReport> run_bench(const BenchInfo& bench, const BenchOptions& options) {
  if (auto checked = check_settings(bench, options); !checked) return checked.error();
  auto report = bench.measure(options);
  if (!report) return report.error();
  auto data = origin_of(bench, options);
  data.update(report->data);
  report->data = std::move(data);
  report->markdown += fmt::format("\n`{}`, {}\n", command_of(bench, options),
                                  report->data["cpu"].get<std::string>());
  return report;
}

Status write_report(const BenchInfo& bench, const BenchReport& report,
                    const std::filesystem::path& dir) {
  std::error_code failure;
  std::filesystem::create_directories(dir, failure);
  if (failure) return Error{fmt::format("{}: {}", dir.string(), failure.message())};
  const auto file = [&](const char* ending) { return dir / (std::string(bench.name) + ending); };
  if (auto done = io::write_file_atomically(file(".json"), report.data.dump(2) + "\n"); !done) {
    return done;
  }
  return io::write_file_atomically(file(".md"), report.markdown);
}

}  // namespace holdfast::benchmarks
