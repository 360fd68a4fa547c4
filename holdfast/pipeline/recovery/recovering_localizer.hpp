#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "holdfast/pipeline/graph/graph_localizer.hpp"
#include "holdfast/pipeline/recovery/scan_window.hpp"
#include "holdfast/relocalization/confirmation.hpp"

namespace holdfast::pipeline {

/// A graph that finds itself: without a pose at the start, and wherever it says that its pose may
/// be wrong, the map is searched with the last scans (article 3.4.2), and the graph goes on from
/// what is found, carried to now by the odometry, unless it is there already. The search runs in a
/// thread of its own and never holds up a step; it takes effect after a time that follows from its
/// work, so that a replay gives the same bits whatever the machine (and waits for it there, if it
/// is not done by then).
class RecoveringLocalizer : public ScanLocalizer {
 public:
  struct Setup {
    RelocalizationConfig config;
    double accept_probability = 0.99;
    Eigen::Vector3d p_body_lidar = Eigen::Vector3d::Zero();
    double range_sigma_m = 0.02;
  };

  /// What searches; its map is read beside the first scans.
  using Loading = std::future<Result<relocalization::GlobalSearch>>;

  /// `graph` has an odometry.
  RecoveringLocalizer(std::unique_ptr<GraphLocalizer> graph, Loading search, const Setup& setup);
  ~RecoveringLocalizer() override;

  void add_imu(const ImuSample& sample) override { graph_->add_imu(sample); }
  StepReport add_scan(const Scan& scan) override;

 private:
  struct Answer {
    relocalization::SearchReport report;
    double cpu_ms = 0;
  };

  /// A search that was begun.
  struct Search {
    TimeNs t = 0;
    SE3 T_odom_body;
    int epoch = 0;
    int scans = 0;
    std::future<Answer> answer;
    std::optional<Answer> done;
  };

  std::shared_ptr<const SearchSummary> end_search(TimeNs now);
  bool accept(const relocalization::SearchReport& report);
  void count_fruitless(const relocalization::SearchReport& report);
  void begin_anew();
  SearchSummary summary_of(const Answer& answer, double latency_s) const;
  Answer search(const relocalization::SearchQuery& query);
  bool is_due(TimeNs now) const;
  void begin_search();
  void describe(StepReport& report) const;

  std::unique_ptr<GraphLocalizer> graph_;
  Loading loading_;
  std::optional<Result<relocalization::GlobalSearch>> search_;  ///< used by one thread at a time
  Setup setup_;
  ScanWindow window_;
  relocalization::Confirmation confirmation_;
  bool in_doubt_ = true;           ///< the pose is not known, or may be wrong
  SE3 T_map_body_;                 ///< as told last; meaningful where it was not LOST
  bool claimed_ = false;           ///< it was not
  int searches_ = 0;               ///< since it is, in this epoch of the odometry
  int epoch_ = 0;                  ///< of them
  int fruitless_ = 0;              ///< in a row, in which no pose of the map fits what is seen
  bool alone_ = false;             ///< the next one is with the newest scan alone
  TimeNs last_search_ = 0;         ///< its newest scan
  TimeNs not_before_ = 0;          ///< the next search
  std::string last_reason_;        ///< of the search before
  std::optional<Search> running_;  // last: its thread uses search_
};

}  // namespace holdfast::pipeline
