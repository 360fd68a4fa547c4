#include "simulation/motion/drive_planner.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulation/motion/drive_ticks.hpp"

namespace holdfast::simulation {
namespace {

// A leg's controls end after its end by these many ticks, so that two legs can be joined.
constexpr std::size_t kTail = 48;

// After a kidnap the body moves on as if nothing had happened for kBlendBegin and has come back to
// its route after kBlendEnd.
constexpr double kBlendBegin = 0.25;
constexpr double kBlendEnd = 1.75;

// A kidnap moves >= 3 m or >= 45 degrees; weaving and smoothing may take a little of that away.
constexpr double kFarMetres = 3.5;
constexpr double kFarRadians = 60.0 / 180.0 * std::numbers::pi;

constexpr double kSharp = 40.0 / 180.0 * std::numbers::pi;  // corners for turning on the spot

constexpr double kCrowdPace = 1.2;  // m/s
constexpr double kHeldBrake = 2.0;  // m/s^2 when somebody stops the robot to carry it away

constexpr double kWobbleSpeed = 0.3;  // m/s from which on the wobble is full

/// `pose` moved by the yaw-only transform that takes pose `a` to the place of pose `b`.
PoseVector moved(const PoseVector& pose, const PoseVector& a, const PoseVector& b) {
  const double turn = b[3] - a[3];
  PoseVector out = pose;
  out.head<3>() =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * (pose - a).head<3>() + b.head<3>();
  out[3] += turn;
  return out;
}

}  // namespace

double DrivePlanner::Wave::at(double x) const { return std::sin(kTwoPi * frequency * x + phase); }

double DrivePlanner::Wave::slope_at(double x) const {
  return kTwoPi * frequency * std::cos(kTwoPi * frequency * x + phase);
}

DrivePlanner::TwoWaves DrivePlanner::draw_waves(RandomStream& random, double longest,
                                                double shortest) {
  const double middle = std::sqrt(longest * shortest);
  return {Wave{1 / random.uniform(middle, longest), random.uniform(0, kTwoPi)},
          Wave{1 / random.uniform(shortest, middle), random.uniform(0, kTwoPi)}};
}

DrivePlanner::DrivePlanner(const Route& route, const DriveStyle& style, std::uint64_t seed)
    : style_(style), gait_(style, seed), kidnap_random_(seed, "drive.kidnap") {
  if (style_.turn_on_spot) style_.weave_m = 0;
  const Route way = style_.turn_on_spot ? route.turning_on_spot(kSharp) : route;
  const Route back = way.reversed();
  courses_.push_back({way, SpeedLimit(way, style)});
  courses_.push_back({back, SpeedLimit(back, style)});
  RandomStream start(seed, "drive.start");
  legs_.push_back({0, start.below(2), start.uniform(0, way.length()), 0});
  legs_[0].s = off_lifts(courses_[legs_[0].course].route, legs_[0].s);
  RandomStream line(seed, "drive.line");
  weave_ = draw_waves(line, 25.0 / 7.0 * style.weave_length_m, style.weave_length_m);
  RandomStream pace(seed, "drive.pace");
  pace_ = draw_waves(pace, 25, 5);
  RandomStream sway(seed, "drive.sway");
  for (auto& waves : sway_) waves = draw_waves(sway, 1.4, 0.4);
  RandomStream wobble(seed, "drive.wobble");
  for (auto& waves : wobble_) waves = draw_waves(wobble, 1.0, 1.0 / 3.0);
}

void DrivePlanner::drive(std::optional<TimeNs> duration, const std::vector<TimeNs>& kidnaps,
                         const std::vector<TimeSpan>& carries) {
  gone_.assign(kLead, 0.0);
  speed_.assign(kLead, 0.0);
  lifted_.assign(kLead, 0.0);
  std::optional<TimeNs> end = duration;
  auto kidnap = kidnaps.begin();
  auto carry = carries.begin();
  bool picked_up = false;
  double gone = 0;
  double speed = 0;
  for (std::size_t tick = kLead; !end || tick_time(tick) < *end + TimeNs{kTail + 1} * kKnot;
       ++tick) {
    const TimeNs t = tick_time(tick);
    for (; kidnap != kidnaps.end() && *kidnap <= t && (!end || *kidnap < *end); ++kidnap) {
      begin_leg(*kidnap, gone - speed * to_seconds(t - *kidnap));
    }
    gone_.push_back(gone);
    speed_.push_back(speed);
    lifted_.push_back(rides_.height(t));
    if (carry != carries.end() && picked_up && t >= carry->end + kReach) {
      ++carry;
      picked_up = false;
    }
    const bool held = carry != carries.end() && carry->begin <= t && (!end || carry->begin < *end);
    if (held && !picked_up && !rides_.is_riding()) picked_up = pick_up(*carry, tick);
    const double target = held ? 0 : target_speed(t, gone, !duration);
    const double step = style_.acceleration_m_s2 * kKnotSeconds;
    const double brake = held ? std::max(1.5 * step, kHeldBrake * kKnotSeconds) : 1.5 * step;
    speed += std::clamp(target - speed, -brake, step);
    gone += speed * kKnotSeconds;
    const bool was_riding = rides_.is_riding();
    rides_.watch(t + kKnot, courses_[legs_.back().course].route, place_on(legs_.back(), gone),
                 speed);
    const bool rides = was_riding || rides_.is_riding();
    if (!end && speed == 0 && !held && !rides && t > from_seconds(style_.rest_s) + kReach) {
      end = (t + kReach) / kSecond * kSecond + 2 * kSecond;
    }
  }
  duration_ = *end;
}

double DrivePlanner::target_speed(TimeNs t, double gone, bool stop_at_distance) const {
  if (t < from_seconds(style_.rest_s) + kReach) return 0;
  const Leg& leg = legs_.back();
  const double seconds = to_seconds(t);
  const double pace = 1 + 0.5 * style_.pace_share * (pace_[0].at(seconds) + pace_[1].at(seconds));
  double target = pace * courses_[leg.course].limit.at(leg.s + gone - leg.gone);
  target = std::min(target, crowd_limit(t));
  const double s = place_on(leg, gone);
  target =
      std::min(target, rides_.speed_limit(courses_[leg.course].route, s, style_.acceleration_m_s2));
  if (stop_at_distance) {
    const double left = style_.distance_m - gone;
    if (left < 0.02) return 0;
    target = std::min(target, std::sqrt(2 * style_.acceleration_m_s2 * left));
  }
  return target;
}

/// A walking pace within the crowds, reached by braking before them.
double DrivePlanner::crowd_limit(TimeNs t) const {
  double limit = std::numeric_limits<double>::infinity();
  for (const TimeSpan& crowd : crowds_) {
    if (t >= crowd.end) continue;
    const double ahead = std::max(0.0, to_seconds(crowd.begin - kReach - t));
    limit = std::min(limit, kCrowdPace + style_.acceleration_m_s2 * ahead);
  }
  return limit;
}

/// Draws the place after a kidnap among those far enough away where the route bends about as it
/// would have bent without the kidnap.
void DrivePlanner::begin_leg(TimeNs t, double gone) {
  const Leg from = legs_.back();
  std::vector<std::pair<double, Leg>> candidates;
  constexpr double kStep = 0.2;
  for (std::size_t course = 0; course < courses_.size(); ++course) {
    for (double s = 0; s < courses_[course].route.length(); s += kStep) {
      const Leg to{t, course, s, gone};
      if (off_lifts(courses_[course].route, s) != s) continue;
      if (is_far(from, to)) candidates.emplace_back(course_difference(from, to, gone), to);
    }
  }
  assert(!candidates.empty());  // the way back at the same place is always one
  double best = candidates.front().first;
  for (const auto& [difference, leg] : candidates) best = std::min(best, difference);
  std::erase_if(candidates, [best](const auto& c) { return c.first > 1.2 * best + 0.05; });
  legs_.push_back(candidates[kidnap_random_.below(candidates.size())].second);
  rides_.leave(t);
  legs_.back().lifted = rides_.height(t);
}

bool DrivePlanner::is_far(const Leg& from, const Leg& to) const {
  const Route::Place a = courses_[from.course].route.at(from.s + to.gone - from.gone);
  const Route::Place b = courses_[to.course].route.at(to.s);
  return (a.position - b.position).norm() >= kFarMetres ||
         std::abs(std::remainder(a.heading - b.heading, kTwoPi)) >=
             kFarRadians + style_.gesture_rad;
}

double DrivePlanner::course_difference(const Leg& from, const Leg& to, double gone) const {
  double worst = 0;
  for (double ahead = -0.75; ahead <= 2.0; ahead += 0.25) {
    const auto a = courses_[from.course].route.at(from.s + gone - from.gone + ahead);
    const auto b = courses_[to.course].route.at(to.s + ahead);
    worst = std::max(worst, std::abs(a.curvature - b.curvature) + std::abs(a.slope - b.slope));
  }
  return worst;
}

/// Where the robot is on a leg when it has gone so far since the start of the log, weaving
/// included.
Route::Place DrivePlanner::place(const Leg& leg, double gone) const {
  Route::Place place = courses_[leg.course].route.at(leg.s + gone - leg.gone);
  const double half = 0.5 * style_.weave_m;
  const double aside = half * (weave_[0].at(gone) + weave_[1].at(gone));
  const double aside_slope = half * (weave_[0].slope_at(gone) + weave_[1].slope_at(gone));
  place.position.x() -= aside * std::sin(place.heading);
  place.position.y() += aside * std::cos(place.heading);
  place.heading += std::atan(aside_slope);
  return place;
}

PoseVector DrivePlanner::pose(const Leg& leg, double gone) const {
  const Route::Place at = place(leg, gone);
  PoseVector pose;
  pose << at.position, at.heading, -std::atan(at.slope), 0;
  pose[2] += style_.body_height_m;
  return pose;
}

/// While the robot rides. The route's height changes at once where its lift is.
double DrivePlanner::height_above_route(const Leg& leg, std::size_t tick) const {
  const Route& route = courses_[leg.course].route;
  if (route.lifts().empty()) return 0;
  return lifted_[tick] - leg.lifted - route.lifted(leg.s, place_on(leg, gone_[tick]));
}

std::size_t DrivePlanner::first_tick(std::size_t leg) const {
  return tick_at(legs_[leg].start) - kLead + kMeanReach;
}

std::size_t DrivePlanner::last_tick(std::size_t leg) const {
  const TimeNs end = leg + 1 < legs_.size() ? legs_[leg + 1].start : duration_;
  return tick_at(end) + kTail - kMeanReach;
}

DrivePlanner::Controls DrivePlanner::plain_controls(std::size_t leg) const {
  Controls raw;
  for (std::size_t tick = first_tick(leg) - kMeanReach; tick <= last_tick(leg) + kMeanReach;
       ++tick) {
    raw.push_back(pose(legs_[leg], gone_[tick]));
    raw.back()[2] += height_above_route(legs_[leg], tick);
  }
  return smoothed(std::move(raw));
}

/// Makes the beginning of leg `leg` continue the motion of the leg before it, at the new place.
void DrivePlanner::join(std::size_t leg, const Controls& before, Controls& after) const {
  const TimeNs t = legs_[leg].start;
  const auto pose_at = [&](std::size_t of, const Controls& controls) {
    return Trajectory(tick_time(first_tick(of)), kKnot, controls).values_at(t).pose;
  };
  const PoseVector from = pose_at(leg - 1, before);
  const PoseVector to = pose_at(leg, after);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const std::size_t tick = first_tick(leg) + i;
    const double since = to_seconds(tick_time(tick) - t);
    if (since >= kBlendEnd) break;
    const double weight = smooth_step((since - kBlendBegin) / (kBlendEnd - kBlendBegin));
    const PoseVector& felt = before[tick - first_tick(leg - 1)];
    after[i] = weight * after[i] + (1 - weight) * moved(felt, from, to);
  }
}

/// Speed at each tick of a leg, as far as `at_most`, smoothed.
std::vector<double> DrivePlanner::speeds(std::size_t leg, double at_most) const {
  std::vector<double> raw;
  for (std::size_t tick = first_tick(leg) - kMeanReach; tick <= last_tick(leg) + kMeanReach;
       ++tick) {
    raw.push_back(std::min(speed_[tick], at_most));
  }
  return smoothed(std::move(raw));
}

/// Adds oscillation that grows with the speed.
void DrivePlanner::add_sway(std::size_t leg, Controls& controls) const {
  const std::size_t first = first_tick(leg);
  const std::vector<double> speed = speeds(leg, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const double t = to_seconds(tick_time(first + i));
    const double envelope = 0.5 * speed[i] / style_.speed_m_s;
    const auto sway = [&](const TwoWaves& w) { return envelope * (w[0].at(t) + w[1].at(t)); };
    controls[i][2] += style_.heave_m * sway(sway_[0]);
    controls[i][4] += style_.sway_rad * sway(sway_[1]);
    controls[i][5] += style_.sway_rad * sway(sway_[2]);
  }
}

/// Adds fast oscillation that is full as soon as the robot moves. A spline of degree 5 through the
/// controls of a wave of frequency f has sinc(f knot)^6 of its amplitude.
void DrivePlanner::add_wobble(std::size_t leg, Controls& controls) const {
  if (style_.wobble_rad == 0) return;
  const std::size_t first = first_tick(leg);
  const std::vector<double> moving = speeds(leg, kWobbleSpeed);
  const auto amplified = [](const Wave& wave, double t) {
    const double x = std::numbers::pi * wave.frequency * kKnotSeconds;
    return wave.at(t) * std::pow(x / std::sin(x), 6);
  };
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const double t = to_seconds(tick_time(first + i));
    const double half = 0.5 * style_.wobble_rad * moving[i] / kWobbleSpeed;
    for (std::size_t k = 0; k < wobble_.size(); ++k) {
      controls[i][static_cast<Eigen::Index>(3 + k)] +=
          half * (amplified(wobble_[k][0], t) + amplified(wobble_[k][1], t));
    }
  }
}

/// Adds what a walking person does, full as soon as it moves.
void DrivePlanner::add_gait(std::size_t leg, Controls& controls) const {
  const std::size_t first = first_tick(leg);
  const std::vector<double> moving = speeds(leg, kWobbleSpeed);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    gait_.add(to_seconds(tick_time(first + i)), moving[i] / kWobbleSpeed, controls[i]);
  }
}

std::vector<Trajectory> DrivePlanner::trajectories() const {
  std::vector<Controls> controls;
  for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
    controls.push_back(plain_controls(leg));
    if (is_carried(leg)) {
      carry(leg, controls[leg]);
    } else if (leg > 0) {
      join(leg, controls[leg - 1], controls[leg]);
    }
  }
  std::vector<Trajectory> out;
  for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
    add_sway(leg, controls[leg]);
    add_wobble(leg, controls[leg]);
    add_gait(leg, controls[leg]);
    out.emplace_back(tick_time(first_tick(leg)), kKnot, std::move(controls[leg]));
  }
  return out;
}

}  // namespace holdfast::simulation
