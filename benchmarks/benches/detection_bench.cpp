#include <fmt/format.h>

#include <mutex>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/detection/detection_score.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "evaluation/result/number_text.hpp"

namespace holdfast::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kForTests = "box";
constexpr std::array kProbabilities = {0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 0.9, 0.99};
constexpr std::array kAlphas = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0};  // Table 8
constexpr std::array kJumpsM = {0.3, 0.5, 0.7};
constexpr std::array kBins = {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 0.9, 1.0};

struct Place {
  std::string scenario;
  std::uint64_t seed = 0;
};

/// The drives of all places, in their order, whichever was done first.
class Drives {
 public:
  Drives(std::size_t places, std::size_t all, const Progress& progress)
      : by_place_(places), all_(all), progress_(progress) {}

  void add(std::size_t place, const std::string& what, Result<MonitoredDrive> drive) {
    const std::lock_guard lock(mutex_);
    progress_(static_cast<double>(++done_) / static_cast<double>(all_), what);
    if (!drive) {
      failures_.push_back(fmt::format("{}: {}", what, drive.error().message));
    } else if (!drive->scans.empty()) {
      by_place_[place].push_back(std::move(*drive));
    }
  }

  template <class OnDrive>
  void each(const OnDrive& on_drive) const {
    for (const auto& drives : by_place_) {
      for (const MonitoredDrive& drive : drives) on_drive(drive);
    }
  }

  const std::vector<std::string>& failures() const { return failures_; }

 private:
  std::vector<std::vector<MonitoredDrive>> by_place_;
  std::vector<std::string> failures_;
  std::size_t all_, done_ = 0;
  const Progress& progress_;
  std::mutex mutex_;
};

void drive_all(std::size_t number, const Place& place, const BenchOptions& options,
               Drives& drives) {
  const DriveSpec spec{place.scenario, place.seed, options.duration_s, 1, options.settings};
  const auto scratch = ScratchFolder::create();
  Result<SurveyedDrive> surveyed =
      scratch ? survey_drive(spec, scratch->path()) : Result<SurveyedDrive>(scratch.error());
  for (const DetectionCase& what : detection_cases(options.duration_s)) {
    drives.add(
        number, fmt::format("{} {}, {}", place.scenario, place.seed, what.name),
        surveyed ? monitor_drive(what, spec, *surveyed) : Result<MonitoredDrive>(surveyed.error()));
  }
}

template <class MakeAlarms>
DetectionScore score(const Drives& drives, const std::string& what, const MakeAlarms& alarms) {
  DetectionScore total;
  drives.each([&](const MonitoredDrive& drive) {
    if (what.empty() || drive.what == what) total.add(drive, alarms(drive));
  });
  return total;
}

Alarms as_configured(const MonitoredDrive& drive) {
  Alarms alarms;
  for (const ScanHealth& scan : drive.scans) alarms.push_back(scan.alarm);
  return alarms;
}

Alarms as_printed(const MonitoredDrive& drive) {
  return alarms_by_dual_index(drive, monitor::DualIndexConfig{});
}

Json json_of(const DetectionScore& score) {
  const evaluation::Interval missed = evaluation::interval_95(score.missed);
  return {{"events", score.missed.of},
          {"missed", score.missed.count},
          {"missed_low", known(missed.low)},
          {"missed_high", known(missed.high)},
          {"delay_p50_s", known(evaluation::quantile(score.delays_s, 0.5))},
          {"delay_p95_s", known(evaluation::quantile(score.delays_s, 0.95))},
          {"false_alarms", score.false_alarms},
          {"right_h", score.right_s / 3600.0},
          {"longest_misleading_s", score.longest_misleading_s}};
}

void add_row(Table& table, const std::string& name, const DetectionScore& score) {
  using namespace evaluation;
  table.add_row({name, count_text(static_cast<double>(score.missed.of)),
                 interval_text(score.missed), seconds_text(quantile(score.delays_s, 0.5)),
                 seconds_text(quantile(score.delays_s, 0.95)),
                 fmt::format("{:.2f} h", score.right_s / 3600.0),
                 count_text(static_cast<double>(score.false_alarms)),
                 plain_text(score.false_alarms_per_h())});
}

Table score_table(const std::string& first) {
  return Table({first, "events", "missed [95 %]", "time to alarm", "95 %", "right", "false alarms",
                "an hour"});
}

void by_kind(const Drives& drives, double duration_s, BenchReport& report) {
  Table table = score_table("kind of drive, detector");
  for (const DetectionCase& what : detection_cases(duration_s)) {
    const DetectionScore ours = score(drives, what.name, as_configured);
    const DetectionScore printed = score(drives, what.name, as_printed);
    add_row(table, what.name + ", evidence", ours);
    add_row(table, what.name + ", dual index", printed);
    report.data["kinds"].push_back(
        {{"kind", what.name}, {"evidence", json_of(ours)}, {"dual_index", json_of(printed)}});
  }
  report.markdown += table.markdown();
}

/// What each threshold would give on the same drives.
void sweep(const Drives& drives, BenchReport& report) {
  Table table = score_table("threshold, all drives");
  for (const double p : kProbabilities) {
    const auto s = score(drives, "", [&](const auto& d) { return alarms_by_probability(d, p); });
    add_row(table, fmt::format("evidence, p >= {}", p), s);
    report.data["sweep"].push_back({{"p", p}, {"score", json_of(s)}});
  }
  for (const double jump_m : kJumpsM) {
    for (const double alpha : kAlphas) {
      monitor::DualIndexConfig config;
      config.residual_sigmas = alpha;
      config.jump_m = jump_m;
      const auto s =
          score(drives, "", [&](const auto& d) { return alarms_by_dual_index(d, config); });
      add_row(table, fmt::format("dual index, alpha {}, d_th {} m", alpha, jump_m), s);
      report.data["sweep"].push_back({{"alpha", alpha}, {"jump_m", jump_m}, {"score", json_of(s)}});
    }
  }
  report.markdown += fmt::format("\n{}", table.markdown());
}

/// Of the scans with a probability between two limits, which share was wrong?
void reliability(const Drives& drives, BenchReport& report) {
  std::array<evaluation::Share, kBins.size() - 1> wrong;
  std::array<double, kBins.size() - 1> sum{};
  drives.each([&](const MonitoredDrive& drive) {
    for (const ScanHealth& scan : drive.scans) {
      if (scan.p_wrong < 0) continue;
      std::size_t bin = 0;
      while (bin + 2 < kBins.size() && scan.p_wrong >= kBins[bin + 1]) ++bin;
      wrong[bin].add(scan.wrong);
      sum[bin] += scan.p_wrong;
    }
  });
  Table table({"probability told", "scans", "mean told", "wrong in truth"});
  for (std::size_t bin = 0; bin < wrong.size(); ++bin) {
    const double told = sum[bin] / std::max<double>(1.0, static_cast<double>(wrong[bin].of));
    table.add_row({fmt::format("{:g} to {:g}", kBins[bin], kBins[bin + 1]),
                   evaluation::count_text(static_cast<double>(wrong[bin].of)),
                   evaluation::share_text(told), evaluation::share_text(wrong[bin].value())});
    report.data["reliability"].push_back({{"from", kBins[bin]},
                                          {"to", kBins[bin + 1]},
                                          {"scans", wrong[bin].of},
                                          {"mean_told", told},
                                          {"wrong", wrong[bin].count}});
  }
  report.markdown += fmt::format("\n{}", table.markdown());
}

Result<std::vector<Place>> places_of(const BenchOptions& options) {
  std::vector<std::string> names = options.scenarios;
  for (const std::string& name : names) {
    if (auto made = simulation::make_scenario(name); !made) return made.error();
  }
  for (const simulation::ScenarioInfo& info : simulation::scenarios()) {
    if (options.scenarios.empty() && info.name != kForTests) names.emplace_back(info.name);
  }
  std::vector<Place> places;
  for (const std::string& name : names) {
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      places.push_back({name, seed});
    }
  }
  return places;
}

}  // namespace

Result<BenchReport> measure_detection(const BenchOptions& options) {
  const auto places = places_of(options);
  if (!places) return places.error();
  const std::size_t kinds = detection_cases(options.duration_s).size();
  Drives drives(places->size(), places->size() * kinds, options.progress);
  WorkerPool(options.threads).run(places->size(), [&](std::size_t i) {
    drive_all(i, (*places)[i], options, drives);
  });
  BenchReport report;
  by_kind(drives, options.duration_s, report);
  sweep(drives, report);
  reliability(drives, report);
  report.data["failures"] = drives.failures();
  report.markdown += fmt::format(
      "\n{} seeds of {} scenarios, {:.0f} s each; events happen halfway. An event is a pose that "
      "becomes more than 0.5 m or 5 degrees wrong; it is missed if there is no alarm within 5 s "
      "(of "
      "motion, after a wrong start). Right: time in which an alarm is false.\n",
      options.seeds.count(), places->size() / options.seeds.count(), options.duration_s);
  for (const std::string& failure : drives.failures()) {
    report.markdown += fmt::format("\nNot driven: {}\n", failure);
  }
  return report;
}

}  // namespace holdfast::benchmarks
