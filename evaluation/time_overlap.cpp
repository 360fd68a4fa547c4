#include "evaluation/time_overlap.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "evaluation/files/text_file.hpp"
#include "holdfast/io/tum_file.hpp"

namespace holdfast::evaluation {
namespace {

struct TimeUnit {
  double per_second;
  std::string_view name;
};
constexpr std::array<TimeUnit, 3> kTimeUnits = {
    TimeUnit{1e9, "nanoseconds"}, TimeUnit{1e6, "microseconds"}, TimeUnit{1e3, "milliseconds"}};

std::string span_text(TimeNs begin, TimeNs end) {
  return fmt::format("{:.3f} to {:.3f} s", to_seconds(begin), to_seconds(end));
}

/// Times of whole drives differ little, so a factor between two first stamps that is a power of a
/// thousand, to 20 %, is a difference of units.
std::string unit_hint(const std::string& name_a, double a_s, const std::string& name_b,
                      double b_s) {
  for (const TimeUnit& unit : kTimeUnits) {
    const auto fits = [&](double large, double small) {
      return small > 0 && std::abs(large / small / unit.per_second - 1) < 0.2;
    };
    if (fits(a_s, b_s)) return fmt::format("; {} looks like {}", name_a, unit.name);
    if (fits(b_s, a_s)) return fmt::format("; {} looks like {}", name_b, unit.name);
  }
  return {};
}

Error no_overlap(const Trajectory& estimate, const TruthTrack& truth, const RunContext& context) {
  std::string hint = unit_hint(context.estimate_name, to_seconds(estimate.front().t),
                               context.truth_name, to_seconds(truth.begin_time()));
  if (hint.empty())
    hint = unit_hint(context.estimate_name, to_seconds(estimate.back().t - estimate.front().t),
                     context.truth_name, to_seconds(truth.end_time() - truth.begin_time()));
  return Error{fmt::format("no overlap in time: {} covers {}, {} covers {}{}",
                           context.estimate_name, span_text(estimate.front().t, estimate.back().t),
                           context.truth_name, span_text(truth.begin_time(), truth.end_time()),
                           hint)};
}

/// First number of the first line that is not a comment; 0 if there is none.
double first_stamp(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#') continue;
    return std::strtod(line.c_str() + begin, nullptr);
  }
  return 0;
}

/// Stamps beyond the year 2200 are no seconds; they are read as the unit that puts them before.
std::string large_stamp_hint(double stamp) {
  constexpr double kYear2200_s = 7.26e9;
  if (!(stamp > kYear2200_s)) return {};
  for (const TimeUnit& unit : {kTimeUnits[2], kTimeUnits[1], kTimeUnits[0]})
    if (stamp / unit.per_second < kYear2200_s)
      return fmt::format(" (stamps are seconds; {:.0f} looks like {})", stamp, unit.name);
  return {};
}

}  // namespace

std::optional<Error> find_time_problem(const Trajectory& estimate, const TruthTrack& truth,
                                       const RunContext& context) {
  if (truth.empty()) return Error{fmt::format("{} holds no pose", context.truth_name)};
  if (estimate.empty()) {
    if (!context.steps.empty()) return std::nullopt;
    return Error{fmt::format("{} holds no pose", context.estimate_name)};
  }
  if (estimate.back().t < truth.begin_time() || estimate.front().t > truth.end_time())
    return no_overlap(estimate, truth, context);
  for (const StampedPose& pose : estimate)
    if (truth.at(pose.t).known()) return std::nullopt;
  return Error{fmt::format(
      "none of the {} poses of {} has a true pose: {} has gaps of more than {:.2f} s there (its "
      "median period is {:.2f} s), and nothing is interpolated across a gap",
      estimate.size(), context.estimate_name, context.truth_name, truth.max_gap_s(),
      truth.period_s())};
}

Result<Trajectory> read_trajectory(const std::filesystem::path& path) {
  const Result<std::string> text = read_text(path);
  if (!text) return text.error();
  const bool blank = text->find_first_not_of(" \t\r\n") == std::string::npos;
  if (blank) return Trajectory{};
  Result<Trajectory> poses = io::read_tum(path);
  if (poses) return poses;
  return Error{poses.error().message + large_stamp_hint(first_stamp(*text))};
}

}  // namespace holdfast::evaluation
