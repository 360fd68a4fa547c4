#include "evaluation/report/event_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "evaluation/result/number_text.hpp"
#include "holdfast/core/se3.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;

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

/// Is the text of a key a list, which is shown as lines of its own?
bool is_list(const std::string& value) { return value.starts_with('['); }

/// "TRACKING to LOST: free space violated, score 0.2" from the keys that a run's events have.
std::string run_event_text(const Event& event) {
  std::string from;
  std::string to;
  std::vector<std::string> parts;
  for (const auto& [key, value] : event.details) {
    if (value.empty() || is_list(value)) continue;
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

std::string detail(const Event& event, const std::string& key) {
  for (const auto& [name, value] : event.details)
    if (name == key) return value;
  return "";
}

Json list_of(const Event& event, const std::string& key) {
  const std::string text = detail(event, key);
  Json list = is_list(text) ? Json::parse(text, nullptr, false) : Json::array();
  return list.is_array() ? list : Json::array();
}

double number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : std::nan("");
}

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// "one pose explains what is seen: 6 scans, 12 ms".
std::string search_text(const Event& event) {
  const double cpu_ms = std::strtod(detail(event, "cpu_ms").c_str(), nullptr);
  const std::string scans = detail(event, "scans");
  return fmt::format("{}{}: {} scan{}, {:.0f} ms",
                     detail(event, "accepted") == "true" ? "accepted, " : "",
                     detail(event, "reason"), scans, scans == "1" ? "" : "s", cpu_ms);
}

/// What each witness of an alarm says; or how good each candidate of a search is.
Json lines_of(const Event& event) {
  Json lines = Json::array();
  for (const Json& e : list_of(event, "evidence")) {
    if (!e.is_object()) continue;
    lines.push_back(fmt::format("{:+.1f} {}", number_at(e, "log_ratio"), text_at(e, "text")));
  }
  for (const Json& c : list_of(event, "candidates")) {
    if (!c.is_object()) continue;
    lines.push_back(
        fmt::format("{:.0f} % likely: {:.0f} % of the returns agree with the map, {:.0f} "
                    "% on the grid",
                    100 * number_at(c, "probability"), 100 * number_at(c, "agreeing"),
                    100 * number_at(c, "score")));
  }
  return lines;
}

Json candidates_of(const Event& event) {
  Json out = Json::array();
  for (const Json& c : list_of(event, "candidates")) {
    const auto pose = c.is_object() ? c.find("pose") : c.end();
    if (!c.is_object() || pose == c.end() || !pose->is_array() || pose->size() != 7) continue;
    std::vector<double> v;
    for (const Json& number : *pose) v.push_back(number.is_number() ? number.get<double>() : 0.0);
    const Eigen::Vector3d x = Eigen::Quaterniond(v[6], v[3], v[4], v[5]) * Eigen::Vector3d::UnitX();
    out.push_back({{"x", v[0]},
                   {"y", v[1]},
                   {"yaw", std::atan2(x.y(), x.x()) * 180.0 / std::numbers::pi},
                   {"probability", number_at(c, "probability")}});
  }
  return out;
}

std::string text_of(const ReportInput& input, const Event& event, bool of_the_world) {
  if (of_the_world && input.evaluation) {
    for (const EventScore& score : input.evaluation->events)
      if (score.event.t0 == event.t0 && score.event.name == event.name) return outcome(score);
  }
  return event.name == "search" && !of_the_world ? search_text(event) : run_event_text(event);
}

}  // namespace

Json event_list_json(const ReportInput& input, TimeNs begin) {
  Json out = Json::array();
  const auto add = [&](const Event& event, bool of_the_world) {
    Json one = {{"t", to_seconds(event.t0 - begin)},
                {"t1", to_seconds(event.t1 - begin)},
                {"name", event.name},
                {"source", of_the_world ? "world" : "run"},
                {"text", text_of(input, event, of_the_world)}};
    if (Json lines = lines_of(event); !lines.empty()) one["lines"] = std::move(lines);
    if (Json places = candidates_of(event); !places.empty()) one["candidates"] = std::move(places);
    out.push_back(std::move(one));
  };
  for (const Event& event : input.events) add(event, true);
  for (const Event& event : input.run_events) add(event, false);
  std::stable_sort(out.begin(), out.end(),
                   [](const Json& a, const Json& b) { return a["t"] < b["t"]; });
  return out;
}

}  // namespace holdfast::evaluation
