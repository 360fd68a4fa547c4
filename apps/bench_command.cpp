#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "apps/commands.hpp"
#include "apps/progress_bar.hpp"
#include "apps/run_options.hpp"
#include "benchmarks/bench.hpp"

namespace holdfast::apps {
namespace {

struct BenchArguments {
  std::string name, out, seeds;
  std::optional<double> duration_s;
  std::vector<std::string> settings, scenarios;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

void bench(const BenchArguments& args) {
  const auto& info = *value_or_fail(benchmarks::find_bench(args.name), 2);
  benchmarks::BenchOptions options;
  options.seeds =
      args.seeds.empty() ? info.seeds : value_or_fail(benchmarks::parse_seeds(args.seeds), 2);
  options.duration_s = args.duration_s.value_or(info.duration_s);
  options.threads = args.threads;
  options.settings = args.settings;
  options.scenarios = args.scenarios;
  options.out = args.out;
  benchmarks::BenchReport report;
  {
    ProgressBar bar("bench " + args.name);
    options.progress = [&](double share, const std::string& what) { bar.update(share, what); };
    report = value_or_fail(benchmarks::run_bench(info, options));
  }
  value_or_fail(benchmarks::write_report(info, report, args.out));
  std::printf("%s", report.markdown.c_str());
}

std::string list_of_benches() {
  std::string text = "Benches:\n";
  for (const auto& info : benchmarks::benches()) {
    const std::string name(info.name);
    text += "  " + name + std::string(16 - name.size(), ' ') + std::string(info.summary) + "\n";
  }
  return text;
}

}  // namespace

void add_bench_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("bench", "Measure speed, accuracy and memory on simulated drives");
  auto args = std::make_shared<BenchArguments>();
  command->add_option("NAME", args->name, "what to measure (see below)")->required();
  command->add_option("--out", args->out, "folder for NAME.json and NAME.md")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--seeds", args->seeds,
                   "drives to take, both ends included (each has a default)")
      ->type_name("A:B");
  command->add_option("--duration", args->duration_s, "seconds of each drive")
      ->check(CLI::Range(1.0, 10000.0))
      ->type_name("S");
  command->add_option("--threads", args->threads, "threads (default: all cores)")
      ->check(CLI::Range(1, 64))
      ->type_name("N");
  command
      ->add_option("--set", args->settings,
                   "module.key=value, over the configuration of each drive; repeatable")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--scenario", args->scenarios,
                   "only this one; repeatable (bench scenarios, features, detection; see simulate "
                   "--list)")
      ->type_name("NAME")
      ->take_all()
      ->allow_extra_args(false);
  command->footer(list_of_benches());
  command->callback([args] { bench(*args); });
}

}  // namespace holdfast::apps
