#include "holdfast/io/logs/kitti_files.hpp"

#include <algorithm>
#include <chrono>

#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/input_file.hpp"
#include "holdfast/io/files/numbers.hpp"

namespace holdfast::io::logs {
namespace {

namespace fs = std::filesystem;
using files::error_at;

constexpr int kDeepestLevel = 3;
constexpr std::string_view kScanFolder = "velodyne_points";

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    entries.push_back(it->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

void find_drives(const fs::path& folder, int level, std::vector<fs::path>& drives) {
  std::error_code error;
  if (fs::is_directory(folder / kScanFolder, error)) {
    drives.push_back(folder);
    return;
  }
  if (level == kDeepestLevel) return;
  for (const auto& entry : sorted_entries(folder)) {
    if (fs::is_directory(entry, error)) find_drives(entry, level + 1, drives);
  }
}

/// `count` digits at `at`; -1 if they are none.
int take_digits(std::string_view text, std::size_t at, std::size_t count) {
  if (at + count > text.size()) return -1;
  int value = 0;
  for (const char c : text.substr(at, count)) {
    if (c < '0' || c > '9') return -1;
    value = value * 10 + (c - '0');
  }
  return value;
}

}  // namespace

Result<fs::path> find_drive(const fs::path& path) {
  std::vector<fs::path> drives;
  const auto clean = path.has_filename() ? path : path.parent_path();
  find_drives(clean, 0, drives);
  if (drives.size() == 1) return drives[0];
  if (drives.empty()) {
    return error_at(path, "is not a KITTI raw drive: no folder {} in it or below", kScanFolder);
  }
  std::string names;
  for (const auto& drive : drives) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", drive.string());
  }
  return error_at(path, "holds {} KITTI raw drives, expected one: {}", drives.size(), names);
}

std::optional<TimeNs> parse_date_time(std::string_view text) {
  constexpr std::string_view kForm = "0000-00-00 00:00:00";
  if (text.size() < kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    if (kForm[i] != '0' && text[i] != kForm[i]) return std::nullopt;
  }
  const int year = take_digits(text, 0, 4), month = take_digits(text, 5, 2);
  const int day = take_digits(text, 8, 2), hour = take_digits(text, 11, 2);
  const int minute = take_digits(text, 14, 2), second = take_digits(text, 17, 2);
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const bool in_range = year >= 1970 && year < 2200 && date.ok() && hour >= 0 && hour < 24 &&
                        minute >= 0 && minute < 60 && second >= 0 && second <= 60;
  if (!in_range) return std::nullopt;
  TimeNs fraction = 0;
  std::string_view rest = text.substr(kForm.size());
  if (!rest.empty() && !parse_seconds(fmt::format("0{}", rest), fraction)) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((TimeNs{days} * 24 + hour) * 60 + minute) * 60 * kSecond + second * kSecond + fraction;
}

Result<std::vector<std::optional<TimeNs>>> read_timestamps(const fs::path& path) {
  const auto text = files::read_text(path);
  if (!text) return text.error();
  std::vector<std::optional<TimeNs>> times;
  std::string_view rest = *text;
  std::string_view line;
  while (files::take_line(rest, line)) {
    times.emplace_back();
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    times.back() = parse_date_time(line);
    if (!times.back()) {
      return error_at(path, "line {}: '{}' is not a time, expected 'YYYY-MM-DD hh:mm:ss.fffffffff'",
                      times.size(), line.substr(0, 40));
    }
  }
  return times;
}

Result<std::vector<TimedFile>> list_timed_files(const fs::path& folder,
                                                std::string_view timestamps) {
  const auto times = read_timestamps(folder / timestamps);
  if (!times) return times.error();
  std::vector<TimedFile> timed;
  for (const auto& path : sorted_entries(folder / "data")) {
    const auto number = files::parse_integer(path.stem().string());
    if ((path.extension() != ".bin" && path.extension() != ".txt") || !number || *number < 0) {
      continue;
    }
    if (static_cast<std::size_t>(*number) >= times->size()) {
      return error_at(folder / timestamps, "has {} lines but there is a file {}", times->size(),
                      path.filename().string());
    }
    const auto& t = (*times)[static_cast<std::size_t>(*number)];
    if (t) timed.push_back({*number, path, *t});
  }
  std::sort(timed.begin(), timed.end(),
            [](const TimedFile& a, const TimedFile& b) { return a.number < b.number; });
  return timed;
}

Result<std::vector<double>> read_oxts(const fs::path& path) {
  const auto text = files::read_text(path);
  if (!text) return text.error();
  std::vector<double> values;
  std::string_view rest = *text;
  std::string_view line;
  files::take_line(rest, line);
  for (const auto word : files::split_words(line)) {
    const auto value = files::parse_double(word);
    if (!value) return error_at(path, "'{}' is not a number", word);
    values.push_back(*value);
  }
  if (values.size() < kOxtsValues) {
    return error_at(path, "{} values, expected at least {}", values.size(), kOxtsValues);
  }
  return values;
}

}  // namespace holdfast::io::logs
