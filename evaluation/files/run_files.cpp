#include "evaluation/files/run_files.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "evaluation/files/text_file.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;

/// Cells of one CSV line; a cell in double quotes may hold commas, and "" for a quote.
Cells split_csv(std::string_view line) {
  Cells cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      const bool doubled = quoted && i + 1 < line.size() && line[i + 1] == '"';
      if (doubled)
        cells.back() += line[++i];
      else
        quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

bool parse_number(const std::string& text, double& value) {
  if (text.empty()) return true;
  char* end = nullptr;
  const double parsed = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) return false;
  value = parsed;
  return true;
}

/// Puts one cell into a row; false if the cell is not of the column's type.
using CellReader = std::function<bool(const std::string&, StepRow&)>;

CellReader number_into(double StepRow::*member) {
  return
      [member](const std::string& cell, StepRow& row) { return parse_number(cell, row.*member); };
}

CellReader text_into(std::string StepRow::*member) {
  return [member](const std::string& cell, StepRow& row) {
    row.*member = cell;
    return true;
  };
}

CellReader time_into(TimeNs StepRow::*member) {
  return
      [member](const std::string& cell, StepRow& row) { return parse_seconds(cell, row.*member); };
}

bool read_epoch(const std::string& cell, StepRow& row) {
  double epoch = 0;
  if (!parse_number(cell, epoch) || !std::isfinite(epoch)) return false;
  row.odom_epoch = static_cast<std::int64_t>(epoch);
  return true;
}

/// "(x y z);(x y z)" as unit vectors. Text of another form declares nothing, which is the strict
/// reading: an error in any direction counts then.
bool read_directions(const std::string& cell, StepRow& row) {
  std::istringstream groups(cell);
  for (std::string group; std::getline(groups, group, ';');) {
    std::array<double, 3> v{};
    if (std::sscanf(group.c_str(), "(%lf %lf %lf)", &v[0], &v[1], &v[2]) != 3) continue;
    const Eigen::Vector3d direction(v[0], v[1], v[2]);
    if (direction.norm() > 1e-6 && direction.allFinite())
      row.weak_directions.push_back(direction.normalized());
  }
  return true;
}

/// The reader of a known column; empty for an unknown one.
CellReader reader_of(const std::string& column, std::vector<std::string>& stages) {
  if (column == "stamp") {
    return [](const std::string& cell, StepRow& row) {
      return cell.empty() || parse_seconds(cell, row.stamp);
    };
  }
  if (column == "pose_time") return time_into(&StepRow::pose_time);
  if (column == "status") return text_into(&StepRow::status);
  if (column == "reason") return text_into(&StepRow::reason);
  if (column == "p_wrong") return number_into(&StepRow::p_wrong);
  if (column == "matches") return number_into(&StepRow::matches);
  if (column == "inlier_share") return number_into(&StepRow::inlier_share);
  if (column == "mean_abs_residual") return number_into(&StepRow::mean_abs_residual_m);
  if (column == "weak_directions") return read_directions;
  if (column == "sigma_trans") return number_into(&StepRow::sigma_trans_m);
  if (column == "sigma_rot") return number_into(&StepRow::sigma_rot_rad);
  if (column == "odom_epoch") return read_epoch;
  if (column == "ms_total") return number_into(&StepRow::ms_total);
  if (column.rfind("ms_", 0) != 0) return {};
  const std::size_t stage = stages.size();
  stages.push_back(column.substr(3));
  return [stage](const std::string& cell, StepRow& row) {
    return parse_number(cell, row.ms_stages[stage]);
  };
}

/// What the header line of a steps.csv says about reading the others.
struct StepsHeader {
  Cells columns;
  std::vector<CellReader> readers;
  std::vector<std::string> stages;
};

Result<StepsHeader> read_header(const std::string& file, std::string_view line) {
  StepsHeader header;
  header.columns = split_csv(line);
  for (const std::string& column : header.columns)
    header.readers.push_back(reader_of(column, header.stages));
  for (const char* needed : {"pose_time", "status"}) {
    bool found = false;
    for (const std::string& column : header.columns) found = found || column == needed;
    if (!found)
      return Error{
          fmt::format("{}: line 1: expected a column \"{}\", found \"{}\"", file, needed, line)};
  }
  return header;
}

Result<StepRow> read_row(const std::string& place, std::string_view line,
                         const StepsHeader& header) {
  const Cells cells = split_csv(line);
  if (cells.size() != header.columns.size())
    return Error{fmt::format("{}: expected {} values as in the header, found {}", place,
                             header.columns.size(), cells.size())};
  StepRow row;
  row.ms_stages.assign(header.stages.size(), kNotKnown);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!header.readers[i] || header.readers[i](cells[i], row)) continue;
    return Error{fmt::format("{}: column {}: expected a number, found \"{}\"", place,
                             header.columns[i], cells[i])};
  }
  if (!state_of(row.status))
    return Error{fmt::format("{}: column status: expected TRACKING, DEGRADED, ..., found \"{}\"",
                             place, row.status)};
  if (row.stamp == 0) row.stamp = row.pose_time;
  return row;
}

Result<StepTable> parse_steps(const std::string& file, std::string_view text) {
  StepTable table;
  StepsHeader header;
  for (std::size_t at = 0, number = 1; at < text.size(); ++number) {
    const std::size_t end = text.find('\n', at);
    const bool has_end = end != std::string_view::npos;
    std::string_view line = text.substr(at, has_end ? end - at : end);
    at = has_end ? end + 1 : text.size();
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (number == 1) {
      Result<StepsHeader> read = read_header(file, line);
      if (!read) return read.error();
      header = std::move(*read);
      table.stages = header.stages;
      continue;
    }
    if (line.empty()) continue;
    const std::string place = fmt::format("{}: line {}", file, number);
    Result<StepRow> row = read_row(place, line, header);
    if (!row && !has_end) {
      table.truncated = true;
      break;
    }
    if (!row) return row.error();
    if (!table.rows.empty() && row->pose_time <= table.rows.back().pose_time)
      return Error{fmt::format("{}: expected a pose_time after {}, found {}", place,
                               format_seconds(table.rows.back().pose_time),
                               format_seconds(row->pose_time))};
    table.rows.push_back(std::move(*row));
  }
  return table;
}

double number_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : kNotKnown;
}

Percentiles percentiles_at(const Json& summary, const char* key) {
  const auto found = summary.find(key);
  if (found == summary.end() || !found->is_object()) return {};
  return {number_at(*found, "p50"), number_at(*found, "p95"), number_at(*found, "p99"),
          number_at(*found, "max")};
}

void flatten_numbers(const std::string& prefix, const Json& object,
                     std::vector<std::pair<std::string, double>>& out) {
  if (!object.is_object()) return;
  for (const auto& [key, value] : object.items()) {
    const std::string name = prefix.empty() ? key : fmt::format("{}.{}", prefix, key);
    if (value.is_object())
      flatten_numbers(name, value, out);
    else if (value.is_number())
      out.emplace_back(name, value.get<double>());
    else if (value.is_boolean())
      out.emplace_back(name, value.get<bool>() ? 1.0 : 0.0);
  }
}

RunSummary summary_of(const Json& json) {
  RunSummary summary;
  summary.scans = number_at(json, "scans");
  summary.duration_s = number_at(json, "duration_s");
  summary.step_ms = percentiles_at(json, "step_ms");
  summary.step_wall_ms = percentiles_at(json, "step_wall_ms");
  summary.peak_rss_mb = number_at(json, "peak_rss_mb");
  summary.relocalizations = number_at(json, "relocalizations");
  summary.realtime_factor = number_at(json, "realtime_factor");
  if (json.contains("method") && json["method"].is_string()) summary.method = json["method"];
  if (json.contains("status_share"))
    flatten_numbers("", json["status_share"], summary.status_share);
  if (json.contains("counters")) flatten_numbers("", json["counters"], summary.counters);
  if (json.contains("warnings") && json["warnings"].is_array())
    for (const Json& warning : json["warnings"])
      if (warning.is_string()) summary.warnings.push_back(warning);
  return summary;
}

}  // namespace

std::optional<State> state_of(const std::string& status) {
  for (int i = 0; i <= static_cast<int>(State::kRelocalizing); ++i)
    if (to_string(static_cast<State>(i)) == status) return static_cast<State>(i);
  return std::nullopt;
}

bool status_claims_pose(const std::string& status) {
  const std::optional<State> state = state_of(status);
  return state && claims_pose(*state);
}

bool status_is_trusted(const std::string& status) {
  return status == "TRACKING" || status == "DEGRADED";
}

Result<StepTable> read_steps(const std::filesystem::path& path) {
  const Result<std::string> text = read_text(path);
  if (!text) return text.error();
  if (text->empty())
    return Error{fmt::format("{}: expected a header line, found an empty file", path.string())};
  return parse_steps(path.string(), *text);
}

Result<RunSummary> read_summary(const std::filesystem::path& path) {
  const Result<std::string> text = read_text(path);
  if (!text) return text.error();
  try {
    const Json json = Json::parse(*text);
    if (!json.is_object())
      return Error{
          fmt::format("{}: expected a JSON object, found {}", path.string(), json.type_name())};
    return summary_of(json);
  } catch (const Json::exception& error) {
    return Error{fmt::format("{}: not valid JSON: {}", path.string(), error.what())};
  }
}

}  // namespace holdfast::evaluation
