#include "holdfast/pipeline/recovery/recovering_localizer.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

namespace holdfast::pipeline {
namespace {

// From where a pose is drawn to the right one by itself, as an initial pose is.
constexpr double kNearM = 1.0;
constexpr double kNearRad = 10.0 * std::numbers::pi / 180.0;

// Of one and the same.
constexpr double kSameM = 0.3;
constexpr double kSameRad = 3.0 * std::numbers::pi / 180.0;
constexpr int kFruitless = 4;

bool are_within(double metres, double radians, const SE3& a, const SE3& b) {
  return (a.translation - b.translation).norm() < metres &&
         so3::angle_between(a.rotation, b.rotation) < radians;
}

}  // namespace

RecoveringLocalizer::RecoveringLocalizer(std::unique_ptr<GraphLocalizer> graph, Loading search,
                                         const Setup& setup)
    : graph_(std::move(graph)),
      loading_(std::move(search)),
      setup_(setup),
      window_(setup.config),
      confirmation_(setup.accept_probability) {}

RecoveringLocalizer::~RecoveringLocalizer() = default;

StepReport RecoveringLocalizer::add_scan(const Scan& scan) {
  auto ended = end_search(scan.end_time);
  StepReport report = graph_->add_scan(scan);
  const bool lost = report.state == State::kLost || !graph_->has_pose();
  const bool doubted = std::exchange(in_doubt_, lost || report.state == State::kSuspect);
  if (in_doubt_ && !doubted) begin_anew();
  claimed_ = !lost;
  T_map_body_ = report.T_map_body;
  const OdometryWitness& witness = *graph_->witness();
  if (witness.tells_motion()) window_.add(witness.odometry(), witness.epoch());
  report.search = std::move(ended);
  if (in_doubt_ && is_due(report.pose_time)) begin_search();
  if (lost) describe(report);
  return report;
}

/// What was seen before the pose came into doubt may be of another place.
void RecoveringLocalizer::begin_anew() {
  window_.clear();
  confirmation_.reset();
  searches_ = fruitless_ = 0;
  alone_ = false;
  last_reason_.clear();
}

/// Takes the answer of the search if it is there by the time of the scan that comes now.
std::shared_ptr<const SearchSummary> RecoveringLocalizer::end_search(TimeNs now) {
  if (!running_) return nullptr;
  if (!running_->done) running_->done = running_->answer.get();
  const Answer& answer = *running_->done;
  const double latency_s =
      1e-9 * setup_.config.ns_per_lookup * static_cast<double>(answer.report.work);
  if (now < running_->t + from_seconds(latency_s)) return nullptr;
  SearchSummary summary = summary_of(answer, latency_s);
  summary.accepted = in_doubt_ && accept(answer.report);
  if (summary.accepted && searches_ > 1) {
    summary.reason = fmt::format("one pose stands after {} searches", searches_);
  }
  last_reason_ = summary.accepted ? "" : summary.reason;
  if (in_doubt_ && !summary.accepted) count_fruitless(answer.report);
  not_before_ = now + from_seconds(setup_.config.retry_s);
  running_.reset();
  return std::make_shared<const SearchSummary>(std::move(summary));
}

/// Where no pose of the map fits what is seen, the odometry may be wrong that put it together, and
/// about the direction of gravity. It begins anew.
void RecoveringLocalizer::count_fruitless(const relocalization::SearchReport& report) {
  if (report.candidates.empty()) return;
  fruitless_ = report.any_fits() ? 0 : fruitless_ + 1;
  if (fruitless_ < kFruitless) return;
  graph_->restart_odometry();
  begin_anew();
}

/// A pose belongs to the scan that was searched with; the odometry carries it to the newest one.
bool RecoveringLocalizer::accept(const relocalization::SearchReport& report) {
  const OdometryWitness& witness = *graph_->witness();
  if (running_->epoch != std::exchange(epoch_, running_->epoch)) {
    confirmation_.reset();
    searches_ = 0;
  }
  ++searches_;
  const TimeNs before = std::exchange(last_search_, running_->t);
  confirmation_.hear(report, running_->T_odom_body, to_seconds(running_->t - before));
  const auto sure = confirmation_.confirmed();
  if (!sure || witness.epoch() != running_->epoch) return false;
  const SE3 T_then_now = running_->T_odom_body.inverse() * witness.odometry().state().T_map_body;
  const SE3 T_map_body = sure->candidate.T_map_body * T_then_now;
  if (claimed_ && are_within(kSameM, kSameRad, T_map_body, T_map_body_)) graph_->confirm();
  if (claimed_ && are_within(kNearM, kNearRad, T_map_body, T_map_body_)) return false;
  graph_->place({T_map_body, sure->candidate.covariance});
  return true;
}

SearchSummary RecoveringLocalizer::summary_of(const Answer& answer, double latency_s) const {
  SearchSummary summary;
  summary.t = running_->t;
  summary.scans = running_->scans;
  summary.outcome = relocalization::name_of(answer.report.outcome);
  summary.reason = answer.report.reason;
  summary.work = answer.report.work;
  summary.latency_s = latency_s;
  summary.cpu_ms = answer.cpu_ms;
  for (const relocalization::Candidate& c : answer.report.candidates) {
    summary.candidates.push_back({c.T_map_body, c.gridded_score, c.agreeing_share, c.probability});
  }
  return summary;
}

/// A robot that is switched on while it drives takes its acceleration for a tilt of several degrees
/// until the second or third scan. A search believes the direction of gravity.
bool RecoveringLocalizer::is_due(TimeNs now) const {
  return !running_ && window_.size() > 0 && window_.newest() == now && now >= not_before_ &&
         graph_->witness()->odometry().gravity_sigma_rad() <= relocalization::kGravitySigmaRad;
}

/// With the whole window and with the newest scan alone by turns: an odometry that went wrong puts
/// a window together that fits nowhere.
void RecoveringLocalizer::begin_search() {
  const OdometryWitness& witness = *graph_->witness();
  const std::size_t scans = std::exchange(alone_, !alone_) ? 1 : window_.size();
  relocalization::SearchQuery query = window_.query(witness.odometry(), setup_.p_body_lidar, scans);
  query.range_sigma_m = setup_.range_sigma_m;
  Search search;
  search.t = window_.newest();
  search.T_odom_body = window_.T_odom_newest();
  search.epoch = window_.epoch();
  search.scans = static_cast<int>(scans);
  search.answer = std::async(std::launch::async,
                             [this, query = std::move(query)] { return this->search(query); });
  running_ = std::move(search);
}

RecoveringLocalizer::Answer RecoveringLocalizer::search(const relocalization::SearchQuery& query) {
  if (!search_) search_ = loading_.get();
  Answer answer;
  if (!*search_) {
    answer.report.reason = "the map cannot be searched: " + search_->error().message;
    return answer;
  }
  const double began = thread_cpu_ms();
  answer.report = (*search_)->find(query);
  answer.cpu_ms = thread_cpu_ms() - began;
  return answer;
}

void RecoveringLocalizer::describe(StepReport& report) const {
  if (!running_ && last_reason_.empty()) return;
  report.state = State::kRelocalizing;
  report.reason = last_reason_.empty() ? "searching the map" : last_reason_;
}

}  // namespace holdfast::pipeline
