#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numbers>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/surveyed_drive.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "benchmarks/relocalization/lost_moments.hpp"
#include "evaluation/evaluate.hpp"
#include "evaluation/result/number_text.hpp"
#include "holdfast/core/stage_clock.hpp"

namespace holdfast::benchmarks {
namespace {

using Json = nlohmann::ordered_json;
using relocalization::SearchOutcome;

constexpr std::array kScenarios = {"corridor", "office", "hall",    "warehouse", "yard",
                                   "tunnel",   "garage", "offices", "campus"};
constexpr std::array kChangedShares = {0.0, 0.2};
constexpr std::string_view kQueries[] = {"one scan", "six scans"};

/// How searches ended.
struct SearchScore {
  evaluation::Share right, wrong, ambiguous, nothing, unsearched;
  std::size_t aliased = 0;         ///< moments at places that look like others
  std::size_t aliased_claims = 0;  ///< of these, with an answer
  std::vector<double> ms, work;

  void add(const LostMoment& moment, const relocalization::SearchReport& report, double its_ms);
};

bool is_near(const SE3& a, const SE3& b) {
  const evaluation::PoseTolerance limit = evaluation::EvaluationOptions{}.misleading;
  return (a.translation - b.translation).norm() <= limit.trans_m &&
         so3::angle_between(a.rotation, b.rotation) * 180.0 / std::numbers::pi <= limit.rot_deg;
}

void SearchScore::add(const LostMoment& moment, const relocalization::SearchReport& report,
                      double its_ms) {
  ms.push_back(its_ms);
  work.push_back(static_cast<double>(report.work));
  const bool found = report.outcome == SearchOutcome::kFound;
  const bool is_right = found && is_near(*report.T_map_body, moment.T_map_body);
  if (!moment.aliases.empty()) {
    ++aliased;
    aliased_claims += found ? 1 : 0;
    wrong.add(found && !is_right);
    return;
  }
  right.add(is_right);
  wrong.add(found && !is_right);
  ambiguous.add(report.outcome == SearchOutcome::kAmbiguous);
  nothing.add(report.outcome == SearchOutcome::kNothing);
  unsearched.add(report.outcome == SearchOutcome::kTooPoor ||
                 report.outcome == SearchOutcome::kOutOfWork);
}

/// One row of the table: a scenario, the world as surveyed or changed, one or six scans.
struct Row {
  std::string scenario;
  double changed_share = 0;
  std::array<SearchScore, 2> by_query;
};

/// Searches at moments of one drive.
Status search_along(const DriveSpec& spec, const SurveyedDrive& surveyed, Row& row,
                    std::mutex& mutex) {
  auto drive = make_drive(spec);
  if (!drive) return drive.error();
  const auto moments = lost_moments(**drive, surveyed.config.T_body_lidar,
                                    surveyed.config.preprocess, MomentOptions{});
  if (!moments) return moments.error();
  auto search = relocalization::GlobalSearch::create(surveyed.map_dir, {});
  if (!search) return search.error();
  for (const LostMoment& moment : *moments) {
    for (std::size_t q = 0; q < row.by_query.size(); ++q) {
      const double before = thread_cpu_ms();
      const auto report = search->find(q == 0 ? moment.scan : moment.scans);
      const double ms = thread_cpu_ms() - before;
      const std::lock_guard lock(mutex);
      row.by_query[q].add(moment, report, ms);
    }
  }
  return Done{};
}

Status search_place(const std::string& scenario, std::uint64_t seed, const BenchOptions& options,
                    std::span<Row> rows, std::mutex& mutex) {
  DriveSpec spec{scenario, seed, options.duration_s, 1, options.settings};
  const auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  const auto surveyed = survey_drive(spec, scratch->path());
  if (!surveyed) return surveyed.error();
  for (Row& row : rows) {
    spec.changed_share = row.changed_share;
    if (auto done = search_along(spec, *surveyed, row, mutex); !done) return done;
  }
  return Done{};
}

std::string share_of(const evaluation::Share& share) {
  return share.of == 0 ? "-" : evaluation::share_text(share.value());
}

void add_to(BenchReport& report, Table& table, const Row& row) {
  for (std::size_t q = 0; q < row.by_query.size(); ++q) {
    const SearchScore& s = row.by_query[q];
    const double p50 = evaluation::quantile(s.ms, 0.5), p95 = evaluation::quantile(s.ms, 0.95);
    const double work_p95 = evaluation::quantile(s.work, 0.95);
    table.add_row({fmt::format("{}{}", row.scenario, row.changed_share > 0 ? ", changed" : ""),
                   std::string(kQueries[q]), fmt::format("{}", s.right.of), share_of(s.right),
                   fmt::format("{}", s.wrong.count), share_of(s.ambiguous), share_of(s.nothing),
                   share_of(s.unsearched), fmt::format("{} / {}", s.aliased_claims, s.aliased),
                   evaluation::milliseconds_text(p50), evaluation::milliseconds_text(p95),
                   fmt::format("{:.0f} M", work_p95 * 1e-6)});
    report.data["rows"].push_back({{"scenario", row.scenario},
                                   {"changed_share", row.changed_share},
                                   {"query", kQueries[q]},
                                   {"moments", s.right.of},
                                   {"right", s.right.count},
                                   {"wrong", s.wrong.count},
                                   {"ambiguous", s.ambiguous.count},
                                   {"nothing", s.nothing.count},
                                   {"unsearched", s.unsearched.count},
                                   {"aliased", s.aliased},
                                   {"aliased_claims", s.aliased_claims},
                                   {"ms_p50", known(p50)},
                                   {"ms_p95", known(p95)},
                                   {"work_p95", known(work_p95)}});
  }
}

}  // namespace

Result<BenchReport> measure_search(const BenchOptions& options) {
  std::vector<std::string> names = options.scenarios;
  for (const std::string& name : names) {
    if (auto made = simulation::make_scenario(name); !made) return made.error();
  }
  if (names.empty()) names.assign(kScenarios.begin(), kScenarios.end());
  std::vector<Row> rows;
  for (const std::string& name : names) {
    for (const double share : kChangedShares) rows.push_back({name, share, {}});
  }
  std::mutex mutex;
  std::vector<std::string> failures;
  std::size_t done = 0;
  const std::size_t seeds = options.seeds.count(), all = names.size() * seeds;
  WorkerPool(options.threads).run(all, [&](std::size_t i) {
    const std::size_t place = i / seeds;
    const std::uint64_t seed = options.seeds.first + i % seeds;
    const auto its_rows =
        std::span(rows).subspan(place * kChangedShares.size(), kChangedShares.size());
    const Status status = search_place(names[place], seed, options, its_rows, mutex);
    const std::lock_guard lock(mutex);
    const std::string what = fmt::format("{}, seed {}", names[place], seed);
    if (!status) failures.push_back(fmt::format("{}: {}", what, status.error().message));
    options.progress(static_cast<double>(++done) / static_cast<double>(all), what);
  });
  BenchReport report;
  Table table({"world", "query", "moments", "found right", "found wrong", "ambiguous", "nothing",
               "not searched", "aliased: answers", "p50", "p95", "look-ups, p95"});
  for (const Row& row : rows) add_to(report, table, row);
  std::sort(failures.begin(), failures.end());
  report.data["failures"] = failures;
  report.markdown = table.markdown();
  report.markdown +=
      "\nThe search alone, at random moments of drives in surveyed worlds; wrong is more than 0.5 "
      "m "
      "or 5 degrees off. Time is that of one thread.\n";
  for (const std::string& failure : failures) {
    report.markdown += fmt::format("\nNot driven: {}\n", failure);
  }
  return report;
}

}  // namespace holdfast::benchmarks
