#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/report/highlights.hpp"
#include "evaluation/report/map_points.hpp"
#include "evaluation/report/report.hpp"
#include "evaluation/report/scan_columns.hpp"
#include "evaluation/result/number_text.hpp"
#include "evaluation/result/verdict.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json verdict_json(const ReportInput& input) {
  const Verdict verdict = input.evaluation
                              ? judge(*input.evaluation)
                              : judge_without_truth(input.scans, !input.steps.rows.empty());
  return {{"light", light_name(verdict.light)},
          {"headline", verdict.headline},
          {"sentence", verdict.sentence}};
}

Json cards_json(const ReportInput& input) {
  Json out = Json::array();
  for (const Card& card : cards(input))
    out.push_back({{"label", card.label},
                   {"value", card.value},
                   {"note", card.note},
                   {"light", light_name(card.light)}});
  return out;
}

Json figures_json(const ReportInput& input) {
  Json out = Json::array();
  for (const FigureGroup& group : figure_groups(input)) {
    Json rows = Json::array();
    for (const Figure& figure : group.figures)
      rows.push_back({figure.label, figure.value, figure.meaning});
    out.push_back({{"name", group.name}, {"rows", std::move(rows)}});
  }
  return out;
}

/// What became of a simulated event, in words.
std::string outcome(const EventScore& score) {
  std::string text;
  const auto add = [&](const std::string& part) {
    text += text.empty() ? part : fmt::format(", {}", part);
  };
  if (score.event.name == "kidnap")
    add(fmt::format("carried {} and {}", length_text(score.moved_m), angle_text(score.moved_deg)));
  if (score.noticed_after_s) add("noticed after " + seconds_text(*score.noticed_after_s));
  add(score.recovery_s ? "recovered after " + seconds_text(*score.recovery_s) : "never recovered");
  if (score.misleading_scans > 0) add(fmt::format("{} misleading scans", score.misleading_scans));
  return text;
}

/// "TRACKING to LOST: free space violated, score 0.2" from the keys that a run's events have.
std::string run_event_text(const Event& event) {
  std::string from;
  std::string to;
  std::vector<std::string> parts;
  for (const auto& [key, value] : event.details) {
    if (value.empty()) continue;
    if (key == "from") {
      from = value;
    } else if (key == "to") {
      to = value;
    } else {
      parts.push_back(key == "reason" ? value : fmt::format("{} {}", key, value));
    }
  }
  const std::string change = from.empty() || to.empty() ? from + to : from + " to " + to;
  const std::string rest = fmt::format("{}", fmt::join(parts, ", "));
  return change.empty() || rest.empty() ? change + rest : fmt::format("{}: {}", change, rest);
}

std::string score_text(const ReportInput& input, const Event& event) {
  if (!input.evaluation) return run_event_text(event);
  for (const EventScore& score : input.evaluation->events)
    if (score.event.t0 == event.t0 && score.event.name == event.name) return outcome(score);
  return run_event_text(event);
}

Json events_json(const ReportInput& input, TimeNs begin) {
  Json out = Json::array();
  const auto add = [&](const Event& event, const char* source, const std::string& text) {
    out.push_back({{"t", to_seconds(event.t0 - begin)},
                   {"t1", to_seconds(event.t1 - begin)},
                   {"name", event.name},
                   {"source", source},
                   {"text", text}});
  };
  for (const Event& event : input.events) add(event, "world", score_text(input, event));
  for (const Event& event : input.run_events) add(event, "run", run_event_text(event));
  std::stable_sort(out.begin(), out.end(),
                   [](const Json& a, const Json& b) { return a["t"] < b["t"]; });
  return out;
}

/// ASCII only, and '<' escaped, so that no text can end the script element that holds it.
std::string safe_dump(const Json& json) {
  std::string safe;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace

std::string report_payload(const ReportInput& input) {
  const TimeNs begin = input.scans.empty() ? 0 : input.scans.front().t;
  Json json;
  json["format"] = 1;
  json["title"] = input.title;
  json["begin"] = format_seconds(begin);
  json["verdict"] = verdict_json(input);
  json["cards"] = cards_json(input);
  json["figures"] = figures_json(input);
  json["warnings"] = warnings(input);
  json["events"] = events_json(input, begin);
  json["scans"] = scan_columns_json(input, begin);
  json["truth"] = truth_path_json(input.truth);
  json["map"] = input.map ? map_points_json(*input.map) : Json(nullptr);
  return safe_dump(json);
}

}  // namespace holdfast::evaluation
