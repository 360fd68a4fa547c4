#include "simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "holdfast/core/parallel.hpp"
#include "simulation/crowd/groups.hpp"
#include "simulation/events/event_schedule.hpp"
#include "simulation/sensors/imu/imu_sensor.hpp"
#include "simulation/sensors/lidar/beam_errors.hpp"
#include "simulation/sensors/lidar/lidar_sensor.hpp"
#include "simulation/transport/losses.hpp"
#include "simulation/world/survey.hpp"

namespace holdfast::simulation {
namespace {

constexpr TimeNs kEpoch = 1'700'000'000 * kSecond;

/// With the errors of this seed's LiDAR.
SimulationOptions as_built(SimulationOptions options) {
  options.lidar = with_beam_errors(std::move(options.lidar), options.seed);
  return options;
}

std::string late_event(const SimulationOptions& options, TimeNs duration) {
  for (const EventSpec& event : options.events) {
    if (event.start >= 0 && event.start < duration) continue;
    return fmt::format("event {} at {} s: expected a start within the log, 0 to {} s",
                       event_name(event.kind), to_seconds(event.start), to_seconds(duration));
  }
  return {};
}

/// A carry for which its span is too short, or that the log would cut off.
std::string hasty_carry(const Drive& drive) {
  for (const Carry& carry : drive.carries()) {
    const double start_s = to_seconds(carry.span.begin);
    const double duration_s = to_seconds(carry.span.end - carry.span.begin);
    if (carry.needs > 0) {
      return fmt::format(
          "event kidnap at {} s: {} s are too short to stop, to be carried 3 m or turned by 45 "
          "degrees by a person, and to be put down; expected at least {:.1f} s",
          start_s, duration_s, to_seconds(carry.needs) + 0.05);
    }
    if (carry.span.end > drive.duration()) {
      return fmt::format("event kidnap at {} s for {} s: expected an end within the log, {} s",
                         start_s, duration_s, to_seconds(drive.duration()));
    }
  }
  return {};
}

std::vector<Mover> all_movers(const Scenario& scenario, const Drive& robot, const Walkers& people,
                              std::uint64_t seed) {
  std::vector<Mover> movers = drive_vehicles(scenario.vehicles, robot, people, seed);
  for (Mover& mover : run_lifts(scenario.lifts, robot)) movers.push_back(std::move(mover));
  return movers;
}

}  // namespace

struct Simulation::Parts {
  SimulationOptions options;
  Scenario scenario;
  std::vector<ObjectChange> changes;
  std::optional<World> world_before;  ///< none: nothing has changed
  RayCaster caster;
  WorkerPool pool;
  Drive drive;
  Walkers walkers;
  Movers movers;
  std::size_t imu_samples;
  TimeNs first_scan;  ///< begin of the first revolution; times here count from the start of the log
  std::size_t scans;  ///< revolutions, those without a message included
  EventSchedule schedule;
  ImuSensor imu;
  LidarSensor lidar;
  LidarClock lidar_clock;
  std::vector<bool> lost_imu;  ///< by sample
  Surroundings around;
  std::vector<SimulatedEvent> events;
  std::optional<TrueGeometry> geometry;  ///< made when asked for

  std::size_t next_imu = 0;
  std::size_t next_scan = 0;    ///< the next to be cast
  std::optional<Scan> pending;  ///< cast but not yet handed out; times from the start of the log
  std::size_t pending_index = 0;
  std::optional<TimeNs> first_pose_time;
  TimeNs last_event = 0;

  Parts(Scenario the_scenario, std::optional<ChangedWorld> change,
        const SimulationOptions& the_options, Drive the_drive,
        const std::vector<CrowdPlan>& crowds);
  TimeNs log_end() const { return static_cast<TimeNs>(imu_samples - 1) * imu.interval(); }
  TimeNs scan_begin(std::size_t scan) const {
    return first_scan + static_cast<TimeNs>(scan) * options.lidar.period;
  }
  bool is_silent(std::size_t scan) const;
  void cast_pending();
  void drop_silent_imu();
  ImuSample take_imu();
  Scan take_scan();
  std::vector<ReturnKind> kinds_of(const Scan& scan);
  TrueState state(TimeNs t) const;
};

Simulation::Parts::Parts(Scenario the_scenario, std::optional<ChangedWorld> change,
                         const SimulationOptions& the_options, Drive the_drive,
                         const std::vector<CrowdPlan>& crowds)
    : options(as_built(the_options)),
      scenario(std::move(the_scenario)),
      changes(change ? change->changes : std::vector<ObjectChange>()),
      world_before(change ? std::optional(std::move(change->before)) : std::nullopt),
      caster(scenario.world),
      pool(options.threads),
      drive(std::move(the_drive)),
      walkers(scenario.walkers, drive, options.seed),
      movers(all_movers(scenario, drive, walkers, options.seed), scenario.world.materials),
      imu_samples(static_cast<std::size_t>(
          static_cast<double>(drive.duration()) * options.imu.rate_hz / 1e9 + 1 + 1e-9)),
      first_scan(from_seconds(RandomStream(options.seed, "lidar.phase").uniform(0.01, 0.06))),
      scans(0),
      schedule(options.events, options.imu, options.transport.lidar_clock, options.seed),
      imu(options.imu, options.seed, imu_samples, schedule.bias_jumps),
      lidar(options.lidar, options.seed, options.weather),
      lidar_clock(options.transport.lidar_clock, schedule.clock_jumps, options.seed),
      lost_imu(draw_losses(options.transport.imu_samples, imu_samples,
                           RandomStream(options.seed, "imu.losses"))),
      around{caster, scenario.world.materials, drive, walkers, movers, schedule.dark()} {
  scans =
      static_cast<std::size_t>(std::max<TimeNs>(log_end() - first_scan, 0) / options.lidar.period);
  for (const CrowdPlan& crowd : crowds) {
    if (crowd.span.begin >= drive.duration()) continue;
    walkers.join(gather_crowd(crowd, drive, options.lidar.T_body_lidar.translation, walkers, caster,
                              options.seed));
  }
  events = schedule.took_place(drive, kEpoch, log_end());
}

/// A revolution that the LiDAR could not begin or finish makes no message.
bool Simulation::Parts::is_silent(std::size_t scan) const {
  const TimeNs begin = scan_begin(scan);
  const auto& off_spans = schedule.lidar_off;
  return std::any_of(off_spans.begin(), off_spans.end(), [&](const TimeSpan& off) {
    return begin < off.end && off.begin < begin + options.lidar.period;
  });
}

void Simulation::Parts::cast_pending() {
  if (pending) return;
  while (next_scan < scans && is_silent(next_scan)) ++next_scan;
  if (next_scan == scans) return;
  pending = lidar.revolve(next_scan, scan_begin(next_scan), around, pool);
  lose_packets(*pending,
               {next_scan, scan_begin(next_scan), options.lidar.period, options.lidar.columns},
               options.transport, options.seed);
  pending_index = next_scan;
  if (!first_pose_time) first_pose_time = pending->end_time;
  ++next_scan;
}

/// Samples that make no message are measured all the same: the noise of later ones stays as it is.
void Simulation::Parts::drop_silent_imu() {
  const auto is_off = [&](TimeNs t) {
    return std::any_of(schedule.imu_off.begin(), schedule.imu_off.end(),
                       [t](const TimeSpan& span) { return span.contains(t); });
  };
  while (next_imu < imu_samples &&
         (lost_imu[next_imu] || is_off(static_cast<TimeNs>(next_imu) * imu.interval()))) {
    take_imu();
  }
}

ImuSample Simulation::Parts::take_imu() {
  const TimeNs t = static_cast<TimeNs>(next_imu) * imu.interval();
  ImuSample sample = imu.measure(next_imu, drive.at(t));
  sample.t = kEpoch + t;
  last_event = t;
  ++next_imu;
  return sample;
}

Scan Simulation::Parts::take_scan() {
  Scan scan = std::move(*pending);
  pending.reset();
  last_event = scan.end_time;
  lidar_clock.stamp(scan, pending_index);
  scan.stamp += kEpoch;
  scan.end_time += kEpoch;
  return scan;
}

/// Where the points of a scan of this log come from. The scan is measured again, and its points
/// found by time and ring.
std::vector<ReturnKind> Simulation::Parts::kinds_of(const Scan& scan) {
  std::vector<ReturnKind> kinds(scan.points.size(), ReturnKind::kSurface);
  const bool all_surfaces = options.lidar.faults.none() && options.weather.is_clear();
  if (scan.points.empty() || all_surfaces) return kinds;
  const auto index = static_cast<std::size_t>(std::max<TimeNs>(
      (scan.stamp + scan.points.front().time_offset_ns - first_scan) / options.lidar.period, 0));
  const auto [again, known] = lidar.revolve_with_kinds(index, scan_begin(index), around, pool);
  std::map<std::pair<TimeNs, std::uint16_t>, ReturnKind> kind_at;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const ScanPoint& point = again.points[i];
    kind_at[{again.stamp + point.time_offset_ns, point.ring}] = known[i];
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const ScanPoint& point = scan.points[i];
    const auto found = kind_at.find({scan.stamp + point.time_offset_ns, point.ring});
    if (found != kind_at.end()) kinds[i] = found->second;
  }
  return kinds;
}

TrueState Simulation::Parts::state(TimeNs t) const {
  const TimeNs clamped = std::clamp<TimeNs>(t, 0, log_end());
  const MotionState motion = drive.at(clamped);
  const auto& bias = imu.bias(static_cast<std::size_t>(clamped / imu.interval()));
  return {kEpoch + t,        motion.T_map_body, motion.v_map, motion.a_map,
          motion.omega_body, bias.gyro,         bias.accel};
}

Result<std::unique_ptr<Simulation>> Simulation::create(const SimulationOptions& options) {
  auto scenario = make_scenario(options.scenario);
  if (!scenario) return scenario.error();
  return create(std::move(*scenario), options);
}

Result<std::unique_ptr<Simulation>> Simulation::create(Scenario scenario,
                                                       const SimulationOptions& options) {
  const std::string wrong = complaint(scenario, options);
  if (!wrong.empty()) return Error{wrong};
  const std::string clashing = clash(options.events);
  if (!clashing.empty()) return Error{clashing};
  scenario.style = style_of(scenario, options);
  std::optional<TimeNs> duration;
  if (options.duration_s) duration = from_seconds(*options.duration_s);
  const auto crowds = plan_crowds(options.events, scenario.groups, options.seed);
  Drive drive = Drive::plan(scenario.route, scenario.style, options.seed, duration,
                            starts_of(EventKind::kKidnap, options.events),
                            spans_of(EventKind::kKidnap, options.events), spans_of(crowds));
  std::optional<ChangedWorld> change;
  if (options.changed_share > 0) {
    auto changed = change_world(scenario, options.changed_share, options.seed);
    if (!changed) return changed.error();
    change = std::move(*changed);
  }
  scenario.world = change ? std::move(change->after) : unchanged_world(scenario.world);
  const std::string late = late_event(options, drive.duration());
  if (!late.empty()) return Error{late};
  const std::string hasty = hasty_carry(drive);
  if (!hasty.empty()) return Error{hasty};
  auto parts = std::make_unique<Parts>(std::move(scenario), std::move(change), options,
                                       std::move(drive), crowds);
  return std::unique_ptr<Simulation>(new Simulation(std::move(parts)));
}

Simulation::Simulation(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Simulation::~Simulation() = default;

Result<std::optional<SensorEvent>> Simulation::next() {
  Parts& p = *parts_;
  p.cast_pending();
  p.drop_silent_imu();
  const bool imu_left = p.next_imu < p.imu_samples;
  const TimeNs imu_time = static_cast<TimeNs>(p.next_imu) * p.imu.interval();
  if (imu_left && !(p.pending && p.pending->end_time < imu_time)) {
    return std::optional<SensorEvent>(p.take_imu());
  }
  if (p.pending) return std::optional<SensorEvent>(p.take_scan());
  return std::optional<SensorEvent>();
}

TimeNs Simulation::last_event_time() const { return kEpoch + parts_->last_event; }

double Simulation::progress() const {
  return static_cast<double>(parts_->next_imu) / static_cast<double>(parts_->imu_samples);
}

TimeNs Simulation::start_time() const { return kEpoch; }
TimeNs Simulation::end_time() const { return kEpoch + parts_->log_end(); }

std::size_t Simulation::scan_count() const {
  std::size_t count = 0;
  for (std::size_t scan = 0; scan < parts_->scans; ++scan) count += parts_->is_silent(scan) ? 0 : 1;
  return count;
}

SE3 Simulation::truth_at(TimeNs t) const { return state_at(t).T_map_body; }
TrueState Simulation::state_at(TimeNs t) const { return parts_->state(t - kEpoch); }

std::vector<StampedPose> Simulation::truth() const {
  std::vector<StampedPose> out;
  const auto& teleports = parts_->drive.teleports();
  auto teleport = teleports.begin();
  for (std::size_t i = 0; i < parts_->imu_samples; ++i) {
    const TimeNs t = static_cast<TimeNs>(i) * parts_->imu.interval();
    for (; teleport != teleports.end() && teleport->t <= t; ++teleport) {
      out.push_back({kEpoch + teleport->t, teleport->before});
      if (teleport->t < t) out.push_back({kEpoch + teleport->t, teleport->after});
    }
    out.push_back({kEpoch + t, parts_->drive.at(t).T_map_body});
  }
  return out;
}

SE3 Simulation::initial_pose() {
  parts_->cast_pending();
  return parts_->drive.at(parts_->first_pose_time.value_or(0)).T_map_body;
}

std::vector<WheelSample> Simulation::wheel_samples() const {
  const Parts& p = *parts_;
  if (!p.options.wheel) return {};
  const WheelOdometer wheels(*p.options.wheel, p.options.seed, p.log_end());
  auto samples = wheels.samples(p.drive);
  for (WheelSample& sample : samples) sample.t += kEpoch;
  return samples;
}

std::vector<GnssSample> Simulation::gnss_samples() const {
  const Parts& p = *parts_;
  if (!p.options.gnss) return {};
  const GnssReceiver receiver(*p.options.gnss, p.options.seed, p.log_end());
  auto samples = receiver.samples(p.drive);
  for (GnssSample& sample : samples) sample.t += kEpoch;
  return samples;
}

const LidarClock& Simulation::lidar_clock() const { return parts_->lidar_clock; }

Scan Simulation::in_true_time(const Scan& scan) const {
  Scan since_start = scan;
  since_start.stamp -= kEpoch;
  since_start.end_time -= kEpoch;
  Scan out = parts_->lidar_clock.in_true_time(since_start);
  out.stamp += kEpoch;
  out.end_time += kEpoch;
  return out;
}

std::vector<TrueReturn> Simulation::true_geometry(const Scan& scan) {
  edges();
  Scan since_start = in_true_time(scan);
  since_start.stamp -= kEpoch;
  since_start.end_time -= kEpoch;
  return true_returns(since_start, parts_->kinds_of(since_start), parts_->options.lidar,
                      parts_->drive, parts_->caster, {parts_->walkers, parts_->movers},
                      *parts_->geometry);
}

const std::vector<Segment>& Simulation::edges() {
  if (!parts_->geometry) parts_->geometry.emplace(parts_->scenario.world);
  return parts_->geometry->edges();
}

const std::vector<SimulatedEvent>& Simulation::events() const { return parts_->events; }
const SimulationOptions& Simulation::options() const { return parts_->options; }
const Scenario& Simulation::scenario() const { return parts_->scenario; }
const Walkers& Simulation::people() const { return parts_->walkers; }
const Movers& Simulation::movers() const { return parts_->movers; }
const std::vector<ObjectChange>& Simulation::changes() const { return parts_->changes; }

io::PointCloud Simulation::survey_map() {
  Parts& p = *parts_;
  SurveyModel model;
  model.height_m = p.scenario.style.body_height_m + p.options.lidar.T_body_lidar.translation.z();
  model.range_m = p.options.lidar.max_range_m;
  model.sigma_m = p.options.map_sigma_m;
  if (!p.world_before && p.scenario.lifts.empty()) {
    return survey(p.scenario.world, p.caster, p.scenario.route, model, p.options.seed, p.pool);
  }
  const World before =
      with_closed_doors(p.world_before ? *p.world_before : p.scenario.world, p.scenario.lifts);
  const RayCaster caster(before);
  return survey(before, caster, p.scenario.route, model, p.options.seed, p.pool);
}

}  // namespace holdfast::simulation
