#include "evaluation/report/highlights.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string_view>

#include "evaluation/result/number_text.hpp"
#include "evaluation/result/result_keys.hpp"

namespace holdfast::evaluation {
namespace {

using Light = Verdict::Light;

Light light_for(double share, double green_from, double amber_from) {
  if (!std::isfinite(share)) return Light::kNone;
  return share >= green_from ? Light::kGreen : share >= amber_from ? Light::kAmber : Light::kRed;
}

std::string out_of(const Share& share) {
  return fmt::format("{} of {} scans", count_text(static_cast<double>(share.count)),
                     count_text(static_cast<double>(share.of)));
}

/// CPU time per step from the summary, else from the rows.
Percentiles step_times(const ReportInput& input) {
  if (input.summary && std::isfinite(input.summary->step_ms.p50)) return input.summary->step_ms;
  std::vector<double> times;
  for (const StepRow& row : input.steps.rows)
    if (std::isfinite(row.ms_total)) times.push_back(row.ms_total);
  return {quantile(times, 0.5), quantile(times, 0.95), quantile(times, 0.99), quantile(times, 1)};
}

Card step_card(const ReportInput& input) {
  const Percentiles ms = step_times(input);
  return {"CPU per scan", milliseconds_text(ms.p50),
          fmt::format("99 of 100 below {}", milliseconds_text(ms.p99)), Light::kNone};
}

Card position_card(const Evaluation& e) {
  return {"Position error, RMSE", length_text(e.trans_m.rmse),
          fmt::format("worst {}", length_text(e.trans_m.max)), Light::kNone};
}

Card rotation_card(const Evaluation& e) {
  return {"Rotation error, RMSE", angle_text(e.rot_deg.rmse),
          fmt::format("worst {}", angle_text(e.rot_deg.max)), Light::kNone};
}

Card coverage_card(const Evaluation& e) {
  return {"Coverage", share_text(e.coverage.value()), out_of(e.coverage),
          light_for(e.coverage.value(), 0.99, 0.9)};
}

Card misleading_card(const Evaluation& e) {
  const bool never = e.misleading.count == 0;
  return {"Misleading", share_text(e.misleading.value()),
          never ? fmt::format("at most {} at 95 %", share_text(interval_95(e.misleading).high))
                : out_of(e.misleading),
          never ? Light::kGreen : Light::kRed};
}

std::vector<Card> judged_cards(const ReportInput& input) {
  const Evaluation& e = *input.evaluation;
  return {position_card(e),
          rotation_card(e),
          coverage_card(e),
          {"Success", share_text(e.success.value()), "within 0.3 m and 5 deg",
           light_for(e.success.value(), 0.99, 0.9)},
          misleading_card(e),
          step_card(input)};
}

Card memory_card(const ReportInput& input) {
  const double memory_mb = input.summary ? input.summary->peak_rss_mb : kNotKnown;
  return {"Peak memory", std::isfinite(memory_mb) ? fmt::format("{:.0f} MB", memory_mb) : "-",
          "resident", Light::kNone};
}

std::vector<Card> odometry_cards(const ReportInput& input) {
  const Evaluation& e = *input.evaluation;
  const auto drift = [](const char* label, const RelativeError& d) -> Card {
    return {label, length_text(d.trans_rmse_m),
            fmt::format("{} % of the way", plain_text(d.drift_percent)), Light::kNone};
  };
  return {position_card(e),
          rotation_card(e),
          drift("Drift over 10 m", e.drift[0]),
          drift("Drift over 50 m", e.drift[2]),
          coverage_card(e),
          step_card(input)};
}

std::vector<Card> unjudged_cards(const ReportInput& input) {
  Share claimed;
  Share trusted;
  for (const ScanRecord& scan : input.scans) {
    claimed.add(scan.claimed);
    trusted.add(scan.claimed && status_is_trusted(scan.status));
  }
  std::vector<double> residuals;
  for (const StepRow& row : input.steps.rows)
    if (std::isfinite(row.mean_abs_residual_m)) residuals.push_back(row.mean_abs_residual_m);
  const double duration_s = to_seconds(input.scans.back().t - input.scans.front().t);
  std::vector<Card> all = {{"Scans", count_text(static_cast<double>(claimed.of)),
                            seconds_text(duration_s), Light::kNone},
                           {"Scans with a pose", share_text(claimed.value()), out_of(claimed),
                            light_for(claimed.value(), 0.99, 0.9)}};
  if (!input.steps.rows.empty())
    all.push_back({"Trusted", share_text(trusted.value()), "TRACKING or DEGRADED",
                   light_for(trusted.value(), 0.995, 0.9)});
  all.push_back(
      {"Residual", length_text(median(residuals)), "median over the scans", Light::kNone});
  all.push_back(memory_card(input));
  all.push_back(step_card(input));
  return all;
}

std::string group_of(const ResultKey& key) {
  const auto starts = [&](std::string_view prefix) { return key.key.rfind(prefix, 0) == 0; };
  if (starts("ate_") || starts("rot_") || starts("e2e")) return "Accuracy";
  if (starts("rpe_") || starts("drift_")) return "Drift";
  if (key.unit == ResultKey::Unit::kShare || starts("misleading") || starts("false_"))
    return "Availability and honesty";
  return "What was judged";
}

void add_result_groups(const Evaluation& evaluation, std::vector<FigureGroup>& groups) {
  for (const char* name : {"Accuracy", "Availability and honesty", "Drift", "What was judged"}) {
    FigureGroup group{name, {}};
    for (const ResultKey& key : result_keys())
      if (group_of(key) == name)
        group.figures.push_back(
            {std::string(key.label), value_text(key, evaluation), std::string(key.meaning)});
    groups.push_back(std::move(group));
  }
}

FigureGroup run_group(const RunSummary& summary) {
  FigureGroup group{"Run", {}};
  const auto add = [&](const char* label, const std::string& value, const char* meaning) {
    if (value != "-" && !value.empty()) group.figures.push_back({label, value, meaning});
  };
  const auto percentiles = [&](const char* label, const Percentiles& p, const char* meaning) {
    if (!std::isfinite(p.p50)) return;
    add(label,
        fmt::format("{} / {} / {} / {} ms", plain_text(p.p50), plain_text(p.p95), plain_text(p.p99),
                    plain_text(p.max)),
        meaning);
  };
  add("method", summary.method, "");
  add("scans", count_text(summary.scans), "scans processed");
  add("duration", seconds_text(summary.duration_s), "of the log");
  percentiles("step, CPU", summary.step_ms, "50, 95, 99 %, worst; thread CPU time");
  percentiles("step, wall", summary.step_wall_ms, "50, 95, 99 %, worst; wall time");
  add("real time", plain_text(summary.realtime_factor), "duration of the log / time taken");
  if (std::isfinite(summary.peak_rss_mb))
    add("peak memory", fmt::format("{:.0f} MB", summary.peak_rss_mb), "resident");
  add("relocalizations", count_text(summary.relocalizations), "accepted");
  for (const auto& [status, share] : summary.status_share)
    add(status.c_str(), share_text(share), "share of the scans");
  return group;
}

FigureGroup counter_group(const RunSummary& summary) {
  FigureGroup group{"Counters", {}};
  for (const auto& [name, value] : summary.counters)
    group.figures.push_back({name, count_text(value), ""});
  return group;
}

struct CounterSentence {
  std::string_view counter;
  std::string_view sentence;
};
constexpr std::array<CounterSentence, 8> kCounterSentences = {{
    {"invalid_points", "points were not finite and were dropped"},
    {"empty_scans", "scans were empty"},
    {"non_finite_imu", "IMU samples were not finite and were dropped"},
    {"imu_stamps_back", "IMU samples were not newer than the one before and were dropped"},
    {"scan_stamps_back", "scans were not newer than the one before and were dropped"},
    {"bad_messages", "messages did not hold together and were dropped"},
    {"imu_gaps", "gaps in the IMU data were bridged"},
    {"imu_held", "scans had no IMU data at their end; the last value was held"},
}};

/// The last part of a name joined by dots.
std::string_view leaf(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return std::string_view(name).substr(dot == std::string::npos ? 0 : dot + 1);
}

void add_counter_warnings(const RunSummary& summary, std::vector<std::string>& out) {
  for (const auto& [name, value] : summary.counters) {
    if (!(value > 0)) continue;
    if (leaf(name) == "truncated") out.push_back("The log ends early; what came before was used");
    for (const CounterSentence& known : kCounterSentences)
      if (leaf(name) == known.counter)
        out.push_back(fmt::format("{} {}", count_text(value), known.sentence));
  }
}

}  // namespace

std::vector<Card> cards(const ReportInput& input) {
  std::vector<Card> all = !input.evaluation                              ? unjudged_cards(input)
                          : input.evaluation->align == Alignment::kRigid ? odometry_cards(input)
                                                                         : judged_cards(input);
  std::erase_if(all, [](const Card& card) { return card.value == "-"; });
  return all;
}

std::vector<FigureGroup> figure_groups(const ReportInput& input) {
  std::vector<FigureGroup> groups;
  if (input.evaluation) add_result_groups(*input.evaluation, groups);
  if (input.summary) groups.push_back(run_group(*input.summary));
  if (input.summary && !input.summary->counters.empty())
    groups.push_back(counter_group(*input.summary));
  return groups;
}

std::vector<std::string> warnings(const ReportInput& input) {
  std::vector<std::string> all = input.warnings;
  if (input.evaluation)
    all.insert(all.end(), input.evaluation->warnings.begin(), input.evaluation->warnings.end());
  if (!input.summary) return all;
  const std::vector<std::string>& told = input.summary->warnings;
  all.insert(all.end(), told.begin(), told.end());
  if (told.empty()) add_counter_warnings(*input.summary, all);
  return all;
}

}  // namespace holdfast::evaluation
