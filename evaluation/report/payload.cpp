#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/report/event_list.hpp"
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
  json["events"] = event_list_json(input, begin);
  json["scans"] = scan_columns_json(input, begin);
  json["truth"] = truth_path_json(input.truth);
  json["map"] = input.map ? map_points_json(*input.map) : Json(nullptr);
  return safe_dump(json);
}

}  // namespace holdfast::evaluation
