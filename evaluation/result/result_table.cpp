#include "evaluation/result/result_table.hpp"

#include <fmt/core.h>

#include "evaluation/result/number_text.hpp"
#include "evaluation/result/verdict.hpp"

namespace holdfast::evaluation {
namespace {

std::string coloured(Verdict::Light light, const std::string& text, bool colours) {
  if (!colours) return text;
  const int code = light == Verdict::Light::kGreen   ? 32
                   : light == Verdict::Light::kAmber ? 33
                   : light == Verdict::Light::kRed   ? 31
                                                     : 36;
  return fmt::format("\x1b[1;{}m{}\x1b[0m", code, text);
}

std::string statistics_row(const char* name, const ErrorStatistics& s,
                           std::string (*text)(double)) {
  return fmt::format("  {:<16}{:>13}{:>13}{:>13}{:>13}\n", name, text(s.rmse), text(s.median),
                     text(s.p95), text(s.max));
}

std::string share_row(const char* name, const Share& share) {
  const Interval interval = interval_95(share);
  const std::string range = share.of == 0 ? std::string()
                                          : fmt::format("   95 %: {:.2f} to {:.2f} %",
                                                        100 * interval.low, 100 * interval.high);
  return fmt::format("  {:<16}{:>13}   {} of {} scans{}\n", name, share_text(share.value()),
                     share.count, share.of, range);
}

std::string drift_row(const RelativeError& drift) {
  const std::string name = fmt::format("drift, {:.0f} m", drift.length_m);
  if (drift.segments == 0) return fmt::format("  {:<16}{:>13}   way too short\n", name, "-");
  return fmt::format("  {:<16}{:>13}   {}, {} % of the way, {} segments\n", name,
                     length_text(drift.trans_rmse_m), angle_text(drift.rot_rmse_deg),
                     plain_text(drift.drift_percent), drift.segments);
}

std::string end_row(const Evaluation& e) {
  if (!e.e2e_m) return fmt::format("  {:<16}{:>13}   no claim there\n", "last scan", "-");
  return fmt::format("  {:<16}{:>13}   {}\n", "last scan", length_text(*e.e2e_m),
                     angle_text(*e.e2e_deg));
}

std::string seconds_or(const std::optional<double>& seconds, const char* otherwise) {
  return seconds ? seconds_text(*seconds) : otherwise;
}

std::string event_rows(const Evaluation& e) {
  if (e.events.empty()) return {};
  std::string text = fmt::format("\n  {:<15}{:>9}{:>9}{:>9}{:>11}{:>11}{:>12}\n", "event", "at",
                                 "moved", "noticed", "recovered", "worst", "misleading");
  for (const EventScore& score : e.events)
    text += fmt::format("  {:<15}{:>9}{:>9}{:>9}{:>11}{:>11}{:>12}\n", score.event.name,
                        seconds_text(to_seconds(score.event.t0 - e.begin)),
                        length_text(score.moved_m), seconds_or(score.noticed_after_s, "never"),
                        seconds_or(score.recovery_s, "never"), length_text(score.worst_claim_m),
                        score.misleading_scans);
  return text;
}

}  // namespace

std::string result_table(const Evaluation& e, bool colours) {
  const Verdict verdict = judge(e);
  std::string text = coloured(verdict.light, verdict.headline, colours) + "\n";
  text += fmt::format("{}\n\n", verdict.sentence);
  text +=
      fmt::format("  {:<16}{:>13}{:>13}{:>13}{:>13}\n", "error", "RMSE", "median", "95 %", "worst");
  text += statistics_row("position", e.trans_m, length_text);
  text += statistics_row("rotation", e.rot_deg, angle_text) + "\n";
  text += share_row("coverage", e.coverage);
  text += share_row("success", e.success);
  text += share_row("misleading", e.misleading);
  if (e.from_steps) text += share_row("trusted", e.trusted);
  text += fmt::format("\n{}", end_row(e));
  for (const RelativeError& drift : e.drift) text += drift_row(drift);
  text += fmt::format("\n  {} of {} claims judged over {} and {}{}\n", e.judged, e.claimed,
                      seconds_text(to_seconds(e.end - e.begin)), length_text(e.path_m),
                      e.align == Alignment::kRigid ? ", after a rigid alignment" : "");
  text += event_rows(e);
  for (const std::string& warning : e.warnings) text += fmt::format("  warning: {}\n", warning);
  return text;
}

}  // namespace holdfast::evaluation
