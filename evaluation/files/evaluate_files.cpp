#include <utility>

#include "evaluation/evaluate.hpp"
#include "evaluation/files/text_file.hpp"
#include "evaluation/time_overlap.hpp"

namespace holdfast::evaluation {
namespace {

/// Reads what a run left beside its trajectory into `context`.
Status read_run(const std::filesystem::path& estimate, RunContext& context) {
  const std::string name = estimate.filename().string();
  context.is_odometry = name == "odometry.tum";
  if (!context.is_odometry && name != "trajectory.tum") return Done{};
  const std::filesystem::path run = estimate.parent_path();
  if (file_exists(run / "steps.csv")) {
    Result<StepTable> steps = read_steps(run / "steps.csv");
    if (!steps) return steps.error();
    context.steps = std::move(steps->rows);
  }
  if (file_exists(run / "events.jsonl") && !context.is_odometry) {
    Result<EventList> events = read_events(run / "events.jsonl");
    if (!events) return events.error();
    context.run_events = std::move(events->events);
  }
  return Done{};
}

}  // namespace

Result<Evaluation> evaluate_files(const EvaluationPaths& paths, const EvaluationOptions& options) {
  RunContext context;
  context.estimate_name = paths.estimate.string();
  context.truth_name = paths.truth.string();
  const Result<Trajectory> estimate = read_trajectory(paths.estimate);
  if (!estimate) return estimate.error();
  const Result<Trajectory> truth = read_trajectory(paths.truth);
  if (!truth) return truth.error();
  if (const Status read = read_run(paths.estimate, context); !read) return read.error();
  if (!paths.events.empty()) {
    Result<EventList> events = read_events(paths.events);
    if (!events) return events.error();
    context.events = std::move(events->events);
  }
  return evaluate(*estimate, *truth, options, context);
}

}  // namespace holdfast::evaluation
