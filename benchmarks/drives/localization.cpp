#include "benchmarks/drives/localization.hpp"

#include "holdfast/map/prior_map.hpp"
#include "holdfast/pipeline/localizer.hpp"
#include "holdfast/pipeline/runner.hpp"

namespace holdfast::benchmarks {
namespace {

evaluation::StepRow row_of(const StepReport& report) {
  evaluation::StepRow row;
  row.stamp = report.stamp;
  row.pose_time = report.pose_time;
  row.status = to_string(report.state);
  row.reason = report.reason;
  row.weak_directions = report.weak_directions;
  row.odom_epoch = report.odom_epoch;
  row.ms_total = report.times.total_ms;
  return row;
}

}  // namespace

Result<std::vector<StepReport>> localize(SensorSource& source, const pipeline::Config& config,
                                         const std::filesystem::path& map_dir,
                                         const std::optional<SE3>& initial_pose) {
  auto map = map::PriorMap::open(map_dir);
  if (!map) return map.error();
  auto localizer = pipeline::Localizer::create(config, std::move(*map), initial_pose);
  if (!localizer) return localizer.error();
  std::vector<StepReport> steps;
  const auto keep = [&](const StepReport& report, double) -> Status {
    steps.push_back(report);
    return Done{};
  };
  if (auto done = pipeline::run(source, *localizer, keep); !done) return done.error();
  return steps;
}

evaluation::Trajectory claims_of(const std::vector<StepReport>& steps) {
  evaluation::Trajectory claims;
  for (const StepReport& step : steps) {
    if (claims_pose(step.state)) claims.push_back({step.pose_time, step.T_map_body});
  }
  return claims;
}

Result<evaluation::Evaluation> judge(const std::vector<StepReport>& steps,
                                     const evaluation::Trajectory& truth) {
  evaluation::RunContext context;
  context.estimate_name = "the run";
  for (const StepReport& step : steps) context.steps.push_back(row_of(step));
  return evaluation::evaluate(claims_of(steps), truth, {}, context);
}

}  // namespace holdfast::benchmarks
