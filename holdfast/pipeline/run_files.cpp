#include "holdfast/pipeline/run_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "holdfast/io/tum_file.hpp"

namespace holdfast::pipeline {
namespace {

/// "(0.00 1.00 0.00);(...)": one vector for each weak direction.
std::string weak_text(const StepReport& report) {
  std::string text;
  for (const auto& d : report.weak_directions) {
    text += fmt::format("{}({:.3f} {:.3f} {:.3f})", text.empty() ? "" : ";", d.x(), d.y(), d.z());
  }
  return text;
}

/// A field of a CSV file: quoted where it holds a comma or a quote.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string steps_header() {
  std::string header =
      "stamp,pose_time,status,reason,p_wrong,matches,inlier_share,mean_abs_residual,"
      "weak_directions,sigma_trans,sigma_rot,odom_epoch,ms_total";
  for (const auto stage : kStageNames) header += fmt::format(",ms_{}", stage);
  return header;
}

std::string format_step(const StepReport& r) {
  std::string line =
      fmt::format("{},{},{},{},{},{},{:.4f},{:.5f},{},{:.6f},{:.7f},{},{:.4f}",
                  format_seconds(r.stamp), format_seconds(r.pose_time), to_string(r.state),
                  csv_text(r.reason), r.p_wrong < 0 ? "" : fmt::format("{:.3g}", r.p_wrong),
                  r.matches, r.inlier_share, r.mean_abs_residual_m, weak_text(r), r.sigma_trans_m,
                  r.sigma_rot_rad, r.odom_epoch, r.times.total_ms);
  for (const double ms : r.times.ms) line += fmt::format(",{:.4f}", ms);
  return line;
}

Result<RunFiles> RunFiles::create(const std::filesystem::path& dir) {
  auto folder = io::AtomicFolder::create(dir, kRunMarker);
  if (!folder) return folder.error();
  RunFiles files(std::move(*folder));
  if (!files.trajectory_ || !files.steps_ || !files.events_) {
    return Error{fmt::format("{}: cannot write into this folder", dir.string())};
  }
  return files;
}

RunFiles::RunFiles(io::AtomicFolder folder)
    : folder_(std::move(folder)),
      trajectory_(folder_.staging() / "trajectory.tum"),
      steps_(folder_.staging() / "steps.csv"),
      events_(folder_.staging() / "events.jsonl") {
  steps_ << steps_header() << '\n';
}

Status RunFiles::add(const StepReport& report) {
  if (claims_pose(report.state)) {
    trajectory_ << io::format_tum_line({report.pose_time, report.T_map_body}) << '\n';
  }
  steps_ << format_step(report) << '\n';
  if (!any_ || report.state != last_state_) add_status(report);
  if (report.alarm && !alarm_) add_alarm(report);
  if (report.search) add_search(report);
  any_ = true;
  last_state_ = report.state;
  alarm_ = report.alarm;
  if (!trajectory_ || !steps_ || !events_) {
    return Error{fmt::format("{}: cannot write: is the disk full?", staging().string())};
  }
  return Done{};
}

void RunFiles::add_status(const StepReport& report) {
  nlohmann::ordered_json rest;
  rest["event"] = "status";
  rest["from"] = any_ ? std::string(to_string(last_state_)) : "";
  rest["to"] = to_string(report.state);
  rest["reason"] = report.reason;
  add_event(report.pose_time, rest);
}

void RunFiles::add_alarm(const StepReport& report) {
  nlohmann::ordered_json rest;
  rest["event"] = "alarm";
  rest["reason"] = report.reason;
  if (report.p_wrong >= 0) rest["p_wrong"] = report.p_wrong;
  for (const Evidence& evidence : report.evidence) {
    rest["evidence"].push_back({{"witness", evidence.witness},
                                {"log_ratio", evidence.log_ratio},
                                {"text", evidence.text}});
  }
  add_event(report.pose_time, rest);
}

/// "search" tells all of it; "relocalized", that its pose was taken over.
void RunFiles::add_search(const StepReport& report) {
  const SearchSummary& search = *report.search;
  nlohmann::ordered_json rest;
  rest["event"] = "search";
  rest["outcome"] = search.outcome;
  rest["reason"] = search.reason;
  rest["accepted"] = search.accepted;
  rest["scans"] = search.scans;
  rest["began_s_ago"] = to_seconds(report.pose_time - search.t);
  rest["latency_s"] = search.latency_s;
  rest["cpu_ms"] = search.cpu_ms;
  rest["work"] = search.work;
  rest["candidates"] = nlohmann::ordered_json::array();
  for (const SearchSummary::Candidate& c : search.candidates) {
    const auto& p = c.T_map_body.translation;
    const auto& q = c.T_map_body.rotation;
    rest["candidates"].push_back({{"pose", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
                                  {"score", c.score},
                                  {"agreeing", c.agreeing},
                                  {"probability", c.probability}});
  }
  add_event(report.pose_time, rest);
  if (!search.accepted) return;
  nlohmann::ordered_json found;
  found["event"] = "relocalized";
  found["reason"] = search.reason;
  add_event(report.pose_time, found);
}

/// The time with all its digits, which a double would not keep.
void RunFiles::add_event(TimeNs t, const nlohmann::ordered_json& rest) {
  events_ << "{\"t\":" << format_seconds(t) << ',' << rest.dump().substr(1) << '\n';
}

Status RunFiles::write(const std::string& name, const std::string& content) {
  return io::write_file_atomically(staging() / name, content);
}

Status RunFiles::close() {
  for (auto* file : {&trajectory_, &steps_, &events_}) {
    file->close();
    if (file->fail()) return Error{fmt::format("{}: cannot write", staging().string())};
  }
  return Done{};
}

}  // namespace holdfast::pipeline
