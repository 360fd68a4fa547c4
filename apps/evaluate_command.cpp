#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "apps/commands.hpp"
#include "evaluation/evaluate.hpp"
#include "evaluation/report/report.hpp"
#include "evaluation/result/result_keys.hpp"
#include "evaluation/result/result_table.hpp"

namespace holdfast::apps {
namespace {

struct EvaluateArguments {
  evaluation::EvaluationPaths paths;
  evaluation::EvaluationOptions options;
  std::string align = "none";
  bool json = false;
  bool report = false;
  bool list_keys = false;
};

bool colours_wanted() { return isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void write_report_of(const EvaluateArguments& arguments) {
  const std::filesystem::path run = arguments.paths.estimate.parent_path();
  evaluation::ReportOptions options;
  options.trajectory = arguments.paths.estimate;
  options.truth = arguments.paths.truth;
  options.events = arguments.paths.events;
  options.evaluation = arguments.options;
  const auto path = evaluation::write_report(run.empty() ? "." : run, options);
  if (!path) throw CommandFailed{1, path.error().message};
  std::fprintf(stderr, "report: %s\n", path->string().c_str());
}

void run_evaluate(EvaluateArguments arguments) {
  if (arguments.list_keys) return print(evaluation::result_key_reference());
  if (arguments.paths.estimate.empty() || arguments.paths.truth.empty())
    throw CommandFailed{2, "evaluate needs ESTIMATE.tum and --truth TRUTH.tum (see --help)"};
  if (arguments.align == "se3") arguments.options.align = evaluation::Alignment::kRigid;
  const auto result = evaluation::evaluate_files(arguments.paths, arguments.options);
  if (!result) throw CommandFailed{1, result.error().message};
  print(arguments.json ? evaluation::result_json(*result)
                       : evaluation::result_table(*result, colours_wanted()));
  if (arguments.report) write_report_of(arguments);
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "evaluate", "how good a trajectory is against the truth (times in seconds)");
  const auto arguments = std::make_shared<EvaluateArguments>();
  command->add_option("ESTIMATE", arguments->paths.estimate,
                      "trajectory as TUM lines; steps.csv and events.jsonl beside a run's "
                      "trajectory.tum are used");
  command->add_option("--truth", arguments->paths.truth, "true trajectory as TUM lines")
      ->type_name("TRUTH.tum");
  command
      ->add_option("--events", arguments->paths.events,
                   "what was done to the robot: adds a line for each event")
      ->type_name("EVENTS.jsonl");
  command
      ->add_option("--align", arguments->align,
                   "se3: best rigid fit first, for an odometry; none: the pose in the map")
      ->check(CLI::IsMember({"none", "se3"}))
      ->capture_default_str();
  command
      ->add_option("--max-truth-gap", arguments->options.max_truth_gap_s,
                   "nothing is interpolated across a longer gap of the truth, in s")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON instead of a table");
  command->add_flag("--report", arguments->report, "write report.html beside the estimate");
  command->add_flag("--keys", arguments->list_keys, "list the keys of --json and their meaning");
  command->callback([arguments] { run_evaluate(*arguments); });
}

}  // namespace holdfast::apps
