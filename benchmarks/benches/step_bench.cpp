#include <fmt/format.h>

#include <array>

#include "benchmarks/benches/all.hpp"
#include "benchmarks/drives/filter_run.hpp"
#include "benchmarks/drives/localization.hpp"
#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/scratch_folder.hpp"
#include "benchmarks/harness/table.hpp"
#include "benchmarks/yardsticks/log_reading.hpp"
#include "evaluation/result/number_text.hpp"
#include "evaluation/statistics.hpp"
#include "holdfast/core/stage_clock.hpp"
#include "holdfast/io/log_file.hpp"

namespace holdfast::benchmarks {
namespace {

/// What is driven through, with what.
struct Course {
  const char* name;
  const char* scenario;
  simulation::LidarModel (*lidar)();
};
constexpr std::array kCourses = {
    Course{"corridor", "corridor", simulation::LidarModel::rs16},
    Course{"office", "office", simulation::LidarModel::rs16},
    Course{"hall", "hall", simulation::LidarModel::rs16},
    Course{"office, 128 x 1024", "office", simulation::LidarModel::os1_128},
};

/// All scans of one course that were tracked, over its seeds.
struct StepFigures {
  std::vector<double> returns, points;
  std::vector<double> step_ms;  ///< of the default localizer, everything on
  std::array<double, kStageNames.size()> stage_ms{};
  std::vector<double> filter_ms, start_ms, tree_ms, reading_ms;
  std::vector<double> step_error_m, filter_error_m, tree_error_m;
  double iterations = 0, searches = 0;  ///< of the tree's registrations, summed
  evaluation::Share trusted;            ///< TRACKING or DEGRADED, by the localizer's own account

  double stage_share(std::size_t stage) const {
    double sum = 0;
    for (const double ms : step_ms) sum += ms;
    return stage_ms[stage] / sum;
  }
  /// Typical time of the k-d-tree registration by that of a whole step, and by map_filter's.
  double tree_by_step() const { return evaluation::median(tree_ms) / evaluation::median(step_ms); }
  double tree_by_filter() const {
    return evaluation::median(tree_ms) / evaluation::median(filter_ms);
  }
  double step_by_reading() const {
    return evaluation::median(step_ms) / evaluation::median(reading_ms);
  }
};

/// Distance to the truth at the scan's end.
double error_m(const SE3& T_map_body, const SE3& truth) {
  return (T_map_body.translation - truth.translation).norm();
}

void add_step(const StepReport& report, const SE3& truth, StepFigures& figures) {
  figures.step_ms.push_back(report.times.total_ms);
  for (std::size_t i = 0; i < kStageNames.size(); ++i) figures.stage_ms[i] += report.times.ms[i];
  figures.step_error_m.push_back(error_m(report.T_map_body, truth));
  figures.trusted.add(report.state == State::kTracking || report.state == State::kDegraded);
}

void add_filtered(const FilteredScan& scan, const SE3& truth, StepFigures& figures) {
  figures.returns.push_back(static_cast<double>(scan.returns));
  figures.points.push_back(static_cast<double>(scan.points.size()));
  figures.filter_ms.push_back(scan.report.times.total_ms);
  figures.filter_error_m.push_back(error_m(scan.report.T_map_body, truth));
}

void add_registration(const FilteredScan& scan, const SE3& truth, const SE3& T_body_lidar,
                      KdTreeRegistration& tree, StepFigures& figures) {
  const double begin = thread_cpu_ms();
  const Registration found = tree.align(scan.points, T_body_lidar.translation, scan.predicted);
  figures.tree_ms.push_back(thread_cpu_ms() - begin);
  figures.tree_error_m.push_back(error_m(found.T_map_body, truth));
  figures.iterations += found.iterations;
  figures.searches += found.searches;
}

/// One drive: recorded, read, localized, and registered again scan by scan. Each pass goes over the
/// whole log, so that none finds the caches as another left them.
Status add_drive(const DriveSpec& spec, StepFigures& figures) {
  auto scratch = ScratchFolder::create();
  if (!scratch) return scratch.error();
  auto drive = survey_drive(spec, scratch->path());
  if (!drive) return drive.error();
  const auto bag = *scratch / "run.bag";
  if (auto recorded = record_bag(*drive->simulation, bag); !recorded) return recorded;
  const auto reading = time_reading(bag);
  if (!reading) return reading.error();
  figures.reading_ms.insert(figures.reading_ms.end(), reading->begin(), reading->end());
  auto log = io::open_log(bag, {});
  if (!log) return log.error();
  const auto steps = localize(**log, drive->config, drive->map_dir, drive->initial_pose);
  if (!steps) return steps.error();
  log = io::open_log(bag, {});
  if (!log) return log.error();
  const auto scans = run_filter(**log, *drive);
  if (!scans) return scans.error();
  auto cloud = drive->simulation->survey_map();
  KdTreeRegistration tree(std::move(cloud.points));
  for (std::size_t i = 0; i < scans->size(); ++i) {
    const FilteredScan& scan = (*scans)[i];
    if (scan.points.size() == 0) {
      figures.start_ms.push_back((*steps)[i].times.total_ms);
      continue;
    }
    const SE3 truth = drive->simulation->truth_at(scan.report.pose_time);
    add_step((*steps)[i], truth, figures);
    add_filtered(scan, truth, figures);
    add_registration(scan, truth, drive->config.T_body_lidar, tree, figures);
  }
  return Done{};
}

nlohmann::ordered_json json_of(const char* course, const StepFigures& f) {
  const auto steps = static_cast<double>(f.step_ms.size());
  nlohmann::ordered_json j;
  j["course"] = course;
  j["scans"] = f.step_ms.size();
  j["returns"] = known(evaluation::median(f.returns));
  j["points"] = known(evaluation::median(f.points));
  j["step_ms"] = json_of(distribution_of(f.step_ms));
  for (std::size_t i = 0; i < kStageNames.size(); ++i) {
    j["stage_share"][std::string(kStageNames[i])] = known(f.stage_share(i));
  }
  j["first_scan_ms"] = known(evaluation::median(f.start_ms));
  j["trusted"] = known(f.trusted.value());
  j["rmse_m"] = known(evaluation::error_statistics(f.step_error_m).rmse);
  j["map_filter"]["step_ms"] = json_of(distribution_of(f.filter_ms));
  j["map_filter"]["rmse_m"] = known(evaluation::error_statistics(f.filter_error_m).rmse);
  j["kd_tree"]["step_ms"] = json_of(distribution_of(f.tree_ms));
  j["kd_tree"]["iterations"] = known(f.iterations / steps);
  j["kd_tree"]["searches"] = known(f.searches / steps);
  j["kd_tree"]["rmse_m"] = known(evaluation::error_statistics(f.tree_error_m).rmse);
  j["reading"]["scan_ms"] = json_of(distribution_of(f.reading_ms));
  j["kd_tree_by_step"] = known(f.tree_by_step());
  j["kd_tree_by_map_filter"] = known(f.tree_by_filter());
  j["step_by_reading"] = known(f.step_by_reading());
  return j;
}

Table times_table() {
  return Table({"course", "returns", "points", "step p50", "p95", "p99", "p99.9", "max",
                "first scan", "map_filter p50", "k-d tree p50", "k-d tree / step",
                "k-d tree / map_filter", "reading p50", "step / reading"});
}

void add_times(const char* course, const StepFigures& f, Table& table) {
  using namespace evaluation;
  const Distribution step = distribution_of(f.step_ms);
  table.add_row({course, count_text(median(f.returns)), count_text(median(f.points)),
                 milliseconds_text(step.p50), milliseconds_text(step.p95),
                 milliseconds_text(step.p99), milliseconds_text(step.p999),
                 milliseconds_text(step.max), milliseconds_text(median(f.start_ms)),
                 milliseconds_text(median(f.filter_ms)), milliseconds_text(median(f.tree_ms)),
                 ratio_text(f.tree_by_step()), ratio_text(f.tree_by_filter()),
                 milliseconds_text(median(f.reading_ms)), ratio_text(f.step_by_reading())});
}

Table shares_table() {
  std::vector<std::string> header = {"course"};
  for (const auto name : kStageNames) header.emplace_back(name);
  header.insert(header.end(), {"trusted", "RMSE", "RMSE, map_filter", "RMSE, k-d tree"});
  return Table(header);
}

void add_shares(const char* course, const StepFigures& f, Table& table) {
  using namespace evaluation;
  std::vector<std::string> row = {course};
  for (std::size_t i = 0; i < kStageNames.size(); ++i) row.push_back(share_text(f.stage_share(i)));
  row.push_back(share_text(f.trusted.value()));
  row.push_back(length_text(error_statistics(f.step_error_m).rmse));
  row.push_back(length_text(error_statistics(f.filter_error_m).rmse));
  row.push_back(length_text(error_statistics(f.tree_error_m).rmse));
  table.add_row(row);
}

constexpr const char* kTimesNote =
    "Thread CPU time. A step is all of the default localizer's work on one scan but the first, "
    "with the odometry beside it, whose own start on one of the next scans is the maximum; "
    "map_filter has neither window nor odometry; the k-d tree's time is its registration alone, "
    "given map_filter's prediction and deskewed points; reading is the decoding of a scan and of "
    "the IMU readings before it from a bag.\n";
constexpr const char* kSharesNote =
    "Shares of the step by stage; scans in TRACKING or DEGRADED; position errors. The k-d tree's "
    "is "
    "of single registrations from map_filter's predictions, which its noisy planes hold it to.\n";

}  // namespace

Result<BenchReport> measure_step(const BenchOptions& options) {
  BenchReport report;
  Table times = times_table();
  Table shares = shares_table();
  const auto all = static_cast<double>(kCourses.size() * options.seeds.count());
  double done = 0;
  for (const Course& course : kCourses) {
    StepFigures figures;
    for (auto seed = options.seeds.first; seed <= options.seeds.last; ++seed) {
      options.progress(done++ / all, fmt::format("{}, seed {}", course.name, seed));
      const DriveSpec spec{course.scenario,  seed,          options.duration_s, options.threads,
                           options.settings, course.lidar()};
      if (auto added = add_drive(spec, figures); !added) return added.error();
    }
    report.data["results"].push_back(json_of(course.name, figures));
    add_times(course.name, figures, times);
    add_shares(course.name, figures, shares);
  }
  report.markdown =
      fmt::format("{}\n{}\n{}\n{}", times.markdown(), kTimesNote, shares.markdown(), kSharesNote);
  return report;
}

}  // namespace holdfast::benchmarks
