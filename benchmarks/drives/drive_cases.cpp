#include "benchmarks/drives/drive_cases.hpp"

namespace holdfast::benchmarks {
namespace {

constexpr double kStart = 0.4;           // of the drive
constexpr double kLength = 0.1;          // likewise
constexpr double kCarriedLength = 0.15;  // a robot is stopped, lifted, carried and put down
constexpr double kChangedShare = 0.2;

}  // namespace

std::vector<DriveCase> drive_cases(double duration_s) {
  std::vector<DriveCase> cases = {
      {"nominal", {}, 0},
      {"changed", {}, kChangedShare},
      {"handheld", {}, 0, simulation::Motion::kHandheld},
  };
  for (const std::string_view name : simulation::event_names()) {
    // The parser knows which events last.
    auto event = *simulation::parse_event(std::string(name) + "@0");
    event.start = from_seconds(kStart * duration_s);
    if (event.duration > 0) event.duration = from_seconds(kLength * duration_s);
    cases.push_back({std::string(name), {event}, 0});
  }
  simulation::EventSpec carried{simulation::EventKind::kKidnap, from_seconds(kStart * duration_s),
                                from_seconds(kCarriedLength * duration_s)};
  cases.push_back({"carried", {carried}, 0});
  return cases;
}

}  // namespace holdfast::benchmarks
