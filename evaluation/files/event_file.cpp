#include "evaluation/files/event_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "evaluation/files/text_file.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Result<TimeNs> time_at(const std::string& place, const Json& line, const char* key) {
  const Json& value = line.at(key);
  constexpr double kLargest_s = 9e9;
  if (!value.is_number() || std::abs(value.get<double>()) > kLargest_s)
    return Error{
        fmt::format("{}: key \"{}\": expected seconds, found {}", place, key, value.dump())};
  return from_seconds(value.get<double>());
}

Result<Event> event_of(const std::string& place, const Json& line) {
  if (!line.is_object() || !line.contains("event") || !line["event"].is_string())
    return Error{fmt::format("{}: expected an object with a text \"event\", found {}", place,
                             line.dump().substr(0, 80))};
  const char* start_key = line.contains("t0") ? "t0" : "t";
  if (!line.contains(start_key))
    return Error{fmt::format("{}: expected a time \"t\" or \"t0\", found none", place)};
  Event event;
  event.name = line["event"];
  const Result<TimeNs> t0 = time_at(place, line, start_key);
  if (!t0) return t0.error();
  event.t0 = event.t1 = *t0;
  if (line.contains("t1") && !line["t1"].is_null()) {
    const Result<TimeNs> t1 = time_at(place, line, "t1");
    if (!t1) return t1.error();
    if (*t1 < *t0) return Error{fmt::format("{}: expected t1 >= t0, found t1 before t0", place)};
    event.t1 = *t1;
  }
  for (const auto& [key, value] : line.items()) {
    if (key == "event" || key == "t" || key == "t0" || key == "t1") continue;
    event.details.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return event;
}

Result<Event> parse_line(const std::string& place, std::string_view text) {
  try {
    return event_of(place, Json::parse(text));
  } catch (const Json::exception& error) {
    return Error{fmt::format("{}: not valid JSON: {}", place, error.what())};
  }
}

}  // namespace

Result<EventList> read_events(const std::filesystem::path& path) {
  const Result<std::string> read = read_text(path);
  if (!read) return read.error();
  const std::string_view text = *read;
  EventList list;
  for (std::size_t at = 0, number = 1; at < text.size(); ++number) {
    const std::size_t end = text.find('\n', at);
    const bool has_end = end != std::string_view::npos;
    const std::string_view line = text.substr(at, has_end ? end - at : end);
    at = has_end ? end + 1 : text.size();
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    Result<Event> event = parse_line(fmt::format("{}: line {}", path.string(), number), line);
    if (!event && !has_end) {
      list.truncated = true;
      break;
    }
    if (!event) return event.error();
    list.events.push_back(std::move(*event));
  }
  std::stable_sort(list.events.begin(), list.events.end(),
                   [](const Event& a, const Event& b) { return a.t0 < b.t0; });
  return list;
}

}  // namespace holdfast::evaluation
