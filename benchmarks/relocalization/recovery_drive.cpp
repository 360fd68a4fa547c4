#include "benchmarks/relocalization/recovery_drive.hpp"

#include <algorithm>
#include <numbers>

#include "benchmarks/drives/localization.hpp"
#include "evaluation/evaluate.hpp"
#include "holdfast/core/random.hpp"
#include "simulation/aliases/aliases.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr TimeNs kHold = 2 * kSecond;
constexpr std::size_t kHoldScans = 18;
constexpr TimeNs kLongestScan = kSecond / 10;
constexpr TimeNs kCarry = 5 * kSecond;
constexpr std::size_t kCarriedOneIn = 3;
constexpr double kAskEveryM = 2;  // whether the place looks like others

bool within(const SE3& claim, const SE3& truth, const evaluation::PoseTolerance& limit) {
  return (claim.translation - truth.translation).norm() <= limit.trans_m &&
         so3::angle_between(claim.rotation, truth.rotation) * 180.0 / std::numbers::pi <=
             limit.rot_deg;
}

bool is_trusted(State state) { return state == State::kTracking || state == State::kDegraded; }

std::vector<simulation::EventSpec> plan_kidnaps(const LossPlan& plan, const DriveSpec& spec) {
  RandomStream random(spec.seed, "losses");
  std::vector<simulation::EventSpec> kidnaps;
  for (double t = plan.first_s; t + 0.5 * plan.every_s < spec.duration_s; t += plan.every_s) {
    const bool carried = kidnaps.size() % kCarriedOneIn == kCarriedOneIn - 1;
    const TimeNs start = from_seconds(t + random.uniform(0, 1));
    kidnaps.push_back({simulation::EventKind::kKidnap, start, carried ? kCarry : 0});
  }
  return kidnaps;
}

std::vector<Recovery> losses_of(const simulation::Simulation& drive) {
  std::vector<Recovery> losses;
  for (const simulation::SimulatedEvent& event : drive.events()) {
    Recovery recovery;
    recovery.loss = event.carried ? Loss::kCarried : Loss::kKidnap;
    recovery.t = recovery.apart = event.t1;
    losses.push_back(recovery);
  }
  return losses;
}

/// Sets from when on the robot can know where it is.
void look_for_aliases(const simulation::Simulation& drive, std::vector<Recovery>& losses) {
  simulation::AliasModel model;
  model.every_m = kAskEveryM;
  const auto stretches = simulation::find_aliases(drive, model);
  for (Recovery& loss : losses) {
    for (const simulation::AliasedStretch& stretch : stretches) {
      if (loss.apart >= stretch.t0 && loss.apart <= stretch.t1) loss.apart = stretch.t1;
    }
    loss.aliased = loss.apart > loss.t;
  }
}

/// A part of a source of events: what was complete up to a time.
class Until final : public SensorSource {
 public:
  explicit Until(simulation::Simulation& whole) : whole_(whole) {}

  void set_end(TimeNs t) { end_ = t; }
  Result<std::optional<SensorEvent>> next() override {
    if (whole_.last_event_time() >= end_) return std::optional<SensorEvent>();
    return whole_.next();
  }
  double progress() const override { return whole_.progress(); }

 private:
  simulation::Simulation& whole_;
  TimeNs end_ = 0;
};

Status skip(SensorSource& source) {
  while (true) {
    const auto event = source.next();
    if (!event) return event.error();
    if (!event->has_value()) return Done{};
  }
}

/// All steps of robots that are switched on, without a pose, after each of `losses`: from the first
/// scan on that saw nothing of the place before.
Result<std::vector<StepReport>> start_after(std::vector<Recovery>& losses,
                                            simulation::Simulation& drive,
                                            const SurveyedDrive& surveyed) {
  std::vector<StepReport> all;
  Until part(drive);
  for (std::size_t i = 0; i < losses.size(); ++i) {
    part.set_end(losses[i].t + kLongestScan);
    if (auto skipped = skip(part); !skipped) return skipped.error();
    part.set_end(i + 1 < losses.size() ? losses[i + 1].t : drive.end_time() + kSecond);
    const auto steps = localize(part, surveyed.config, surveyed.map_dir, std::nullopt);
    if (!steps) return steps.error();
    if (!steps->empty()) losses[i].t = steps->front().pose_time;
    losses[i].apart = std::max(losses[i].apart, losses[i].t);
    all.insert(all.end(), steps->begin(), steps->end());
  }
  return all;
}

/// Each loss until the next one.
std::vector<Recovery> score_all(const std::vector<Recovery>& losses,
                                const std::vector<StepReport>& steps,
                                const simulation::Simulation& drive) {
  std::vector<Recovery> scored;
  const auto truth = [&](TimeNs t) { return drive.truth_at(t); };
  for (std::size_t i = 0; i < losses.size(); ++i) {
    const TimeNs until = i + 1 < losses.size() ? losses[i + 1].t : drive.end_time() + kSecond;
    scored.push_back(score_recovery(losses[i], steps, until, truth));
  }
  return scored;
}

}  // namespace

Recovery score_recovery(Recovery loss, const std::vector<StepReport>& steps, TimeNs until,
                        const std::function<SE3(TimeNs)>& truth) {
  const evaluation::EvaluationOptions limits;
  TimeNs good_since = 0, before = loss.t;
  std::size_t good = 0;  // scans since
  for (const StepReport& step : steps) {
    if (step.pose_time < loss.t || step.pose_time >= until) continue;
    const SE3 T_true = truth(step.pose_time);
    const bool misleads = !within(step.T_map_body, T_true, limits.misleading);
    loss.step_ms = std::max(loss.step_ms, step.times.total_ms);
    if (step.search) {
      ++loss.searches;
      loss.search_ms = std::max(loss.search_ms, step.search->cpu_ms);
      if (step.search->accepted && misleads) ++loss.false_relocalizations;
    }
    if (step.state == State::kTracking && misleads) {
      loss.misleading_s += to_seconds(step.pose_time - before);
    }
    before = step.pose_time;
    if (loss.found_after_s) continue;
    if (!is_trusted(step.state) || !within(step.T_map_body, T_true, limits.success)) {
      good = 0;
      continue;
    }
    if (good++ == 0) good_since = step.pose_time;
    if (good >= kHoldScans && step.pose_time - good_since >= kHold) {
      loss.found_after_s = std::max(0.0, to_seconds(good_since - loss.apart));
    }
  }
  return loss;
}

Result<std::vector<Recovery>> recover_all(DriveSpec spec, const SurveyedDrive& surveyed,
                                          const LossPlan& plan) {
  spec.events = plan_kidnaps(plan, spec);
  auto drive = make_drive(spec);
  if (!drive) return drive.error();
  std::vector<Recovery> losses = losses_of(**drive);
  look_for_aliases(**drive, losses);
  const auto steps = localize(**drive, surveyed.config, surveyed.map_dir, (*drive)->initial_pose());
  if (!steps) return steps.error();
  std::vector<Recovery> all = score_all(losses, *steps, **drive);

  auto again = make_drive(spec);
  if (!again) return again.error();
  for (Recovery& loss : losses) loss.loss = Loss::kStart;
  const auto starts = start_after(losses, **again, surveyed);
  if (!starts) return starts.error();
  for (const Recovery& r : score_all(losses, *starts, **drive)) all.push_back(r);
  return all;
}

}  // namespace holdfast::benchmarks
