#include "benchmarks/drives/filter_run.hpp"

#include <Eigen/LU>
#include <numbers>

#include "holdfast/pipeline/event_sequencer.hpp"

namespace holdfast::benchmarks {
namespace {

using baselines::MapFilter;
using filter::FilterState;

/// Repeats what the filter did with a scan before it asked the map, from a copy of its state.
class Repeater {
 public:
  Repeater(const MapFilter& filter, const MapFilter::Setup& setup)
      : filter_(filter), setup_(setup), gravity_(filter.map().info().gravity_map) {}

  void fill(const Scan& scan, FilterState state, std::uint64_t scan_number, FilteredScan& out) {
    filter_.imu().segment(state.t, scan.end_time, imu_);
    filter::propagate(state, imu_, gravity_, setup_.imu);
    out.predicted.T_map_body = state.T_map_body;
    out.predicted.information = state.P.topLeftCorner<6, 6>().inverse();
    preprocess::select_points(scan, setup_.selection, scan_number, selected_);
    deskew(scan, state, out.points);
  }

 private:
  void deskew(const Scan& scan, const FilterState& state, registration::BodyPoints& out) {
    const Eigen::Quaterniond R_body_map = state.T_map_body.rotation.conjugate();
    filter_.imu().segment(scan.stamp, scan.end_time, imu_);
    motion_.set(
        imu_, {R_body_map * state.v_map, R_body_map * gravity_, state.gyro_bias, state.accel_bias},
        setup_.T_body_lidar, scan.stamp, scan.end_time);
    out.resize(selected_.size());
    for (std::size_t i = 0; i < selected_.size(); ++i) {
      const ScanPoint& p = scan.points[selected_[i]];
      out.points[i] = motion_.deskew(p);
      out.age_s[i] = static_cast<float>(to_seconds(scan.stamp + p.time_offset_ns - scan.end_time));
    }
  }

  const MapFilter& filter_;
  const MapFilter::Setup& setup_;
  Eigen::Vector3d gravity_;
  preprocess::ImuSegment imu_;
  preprocess::ScanMotion motion_;
  std::vector<std::uint32_t> selected_;
};

}  // namespace

Result<std::vector<FilteredScan>> run_filter(SensorSource& log, const SurveyedDrive& drive) {
  auto map = map::PriorMap::open(drive.map_dir);
  if (!map) return map.error();
  const MapFilter::Setup setup = pipeline::filter_setup(drive.config);
  MapFilter filter(std::move(*map), setup, drive.initial_pose);
  Repeater repeater(filter, setup);
  std::vector<FilteredScan> scans;
  pipeline::EventSequencer sequencer;
  for (bool more = true; more;) {
    auto event = log.next();
    if (!event) return event.error();
    more = event->has_value();
    if (more) sequencer.push(std::move(**event));
    if (!more) sequencer.finish();
    for (SensorEvent ready; sequencer.pop(ready);) {
      if (const auto* imu = std::get_if<ImuSample>(&ready)) {
        filter.add_imu(*imu);
        continue;
      }
      const auto& scan = std::get<Scan>(ready);
      const FilterState before = filter.state();
      FilteredScan& out = scans.emplace_back();
      out.report = filter.add_scan(scan);
      out.returns = scan.points.size();
      if (before.t > 0) repeater.fill(scan, before, scans.size() - 1, out);
    }
  }
  return scans;
}

}  // namespace holdfast::benchmarks
