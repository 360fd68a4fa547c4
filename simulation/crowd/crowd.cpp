#include "simulation/crowd/crowd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "holdfast/core/random.hpp"
#include "simulation/crowd/crowd_walk.hpp"
#include "simulation/motion/smoothing.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kRounds = 0.12;  // rad/s at which a ring walks round the robot

constexpr TimeNs kComing = 5 * kSecond / 2;
constexpr std::size_t kSplineMargin = 3;
constexpr std::size_t kPad = kMeanReach + kSplineMargin;
constexpr std::size_t kMostLeaving = 1200;  // ticks
constexpr std::size_t kLookEvery = 5;       // ticks
constexpr double kFar = 25;                 // metres from which on people may come and go in view
constexpr double kLeastRoom = 0.5;          // metres from the robot's axis
constexpr double kGroundReach = 5;          // metres below the body
constexpr TimeNs kForever = std::numeric_limits<TimeNs>::max() / 4;

/// Where one member is at consecutive ticks, from when to when.
struct Way {
  std::vector<Vector3d> places;
  bool gone = false;  ///< nobody sees the end
};

/// Plans a crowd from the time at which it is complete forwards and backwards.
class Gathering {
 public:
  Gathering(const CrowdPlan& plan, const Drive& robot, const Vector3d& eye, const Walkers& others,
            const RayCaster& world, std::uint64_t seed)
      : plan_(plan),
        span_(densest(plan.span)),
        robot_(robot),
        eye_(eye),
        others_(others),
        world_(world),
        seed_(seed) {}

  std::vector<Passer> plan() const {
    const std::vector<CrowdMember> placed = place_members();
    auto members = placed;
    for (CrowdMember& member : members) member.is_leaving = true;
    const std::vector<Way> before = leave(members, span_.begin, -1);
    members = placed;
    std::vector<Way> during = mingle(members);
    for (CrowdMember& member : members) member.is_leaving = true;
    const std::vector<Way> after = leave(members, span_.begin + mingling(), 1);
    std::vector<Passer> out;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const Passer passer = joined(before[i], during[i], after[i], i);
      if (keeps_clear(passer)) out.push_back(passer);
    }
    return out;
  }

 private:
  TimeNs mingling() const { return (span_.end - span_.begin) / kCrowdTick * kCrowdTick; }

  CrowdScene scene(TimeNs t, int direction) const {
    CrowdScene scene;
    const MotionState state = robot_.at(t);
    scene.robot = state.T_map_body.translation;
    scene.robot_velocity = direction * state.v_map.head<2>();
    for (std::size_t i = 0; i < others_.size(); ++i) {
      if (others_.is_there(i, t))
        scene.others.emplace_back(others_.at(i, t).T_map_body.translation.head<2>());
    }
    return scene;
  }

  /// In two rings round the robot where there is room that can be reached from it.
  std::vector<CrowdMember> place_members() const {
    const Vector3d robot = robot_.at(span_.begin).T_map_body.translation;
    const auto ground = world_.ground_under(robot, kGroundReach);
    std::vector<CrowdMember> members;
    if (!ground) return members;
    RandomStream random(seed_, "crowd.places." + std::to_string(span_.begin));
    const double turned = random.uniform(0, kTwoPi);
    const auto inner_count = static_cast<double>(plan_.inner);
    const auto outer_count = static_cast<double>(plan_.outer);
    for (std::size_t i = 0; i < plan_.inner + plan_.outer; ++i) {
      const bool inner = i < plan_.inner;
      const auto share = inner ? static_cast<double>(i) / inner_count
                               : (static_cast<double>(i - plan_.inner) + 0.5) / outer_count;
      CrowdMember member;
      member.room = plan_.room_m;
      member.angle = turned + kTwoPi * share + random.uniform(-0.1, 0.1);
      member.distance =
          inner ? random.uniform(plan_.nearest_m, plan_.farthest_m) : random.uniform(1.6, 2.8);
      const Vector3d foot(robot.x(), robot.y(), *ground);
      if (place(foot, member)) members.push_back(member);
    }
    return members;
  }

  /// On the way to its place, as far as there is room.
  bool place(const Vector3d& foot, CrowdMember& member) const {
    const Vector2d direction(std::cos(member.angle), std::sin(member.angle));
    const double least = plan_.nearest_m - 0.1;
    for (double distance = member.distance; distance >= least; distance -= 0.15) {
      Vector3d there = foot;
      there.head<2>() += distance * direction;
      const auto ground = world_.ground_under(there + Vector3d(0, 0, 0.6), 1.2);
      if (!ground) continue;
      there.z() = *ground;
      if (std::abs(there.z() - foot.z()) > 0.25 * distance || !world_.is_free(foot, there))
        continue;
      member.place = there;
      return true;
    }
    return false;
  }

  std::vector<Way> mingle(std::vector<CrowdMember>& members) const {
    std::vector<Way> ways(members.size());
    for (TimeNs t = span_.begin; t < span_.begin + mingling(); t += kCrowdTick) {
      for (std::size_t i = 0; i < members.size(); ++i) {
        ways[i].places.push_back(members[i].place);
        const double sense = members[i].distance < 1.5 ? 1 : -1;
        members[i].angle += sense * kRounds * to_seconds(kCrowdTick);
      }
      walk_on(members, scene(t, 1), world_);
    }
    return ways;
  }

  /// From `begin` on, or backwards in time, until nobody sees them, and a little longer.
  std::vector<Way> leave(std::vector<CrowdMember>& members, TimeNs begin, int direction) const {
    std::vector<Way> ways(members.size());
    std::vector<std::size_t> ends(members.size(), kMostLeaving);
    for (std::size_t tick = 0; tick < kMostLeaving; ++tick) {
      const TimeNs t = begin + direction * static_cast<TimeNs>(tick) * kCrowdTick;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (tick < ends[i] + kPad) ways[i].places.push_back(members[i].place);
        if (ways[i].gone || tick % kLookEvery != 0 || !is_gone(members[i].place, t)) continue;
        ways[i].gone = true;
        ends[i] = tick;
      }
      const bool all = std::all_of(ends.begin(), ends.end(),
                                   [tick](std::size_t end) { return tick > end + kPad; });
      if (all) break;
      walk_on(members, scene(t, direction), world_);
    }
    return ways;
  }

  bool is_gone(const Vector3d& place, TimeNs t) const {
    const Vector3d eye = robot_.at(t).T_map_body * eye_;
    return (place - eye).head<2>().norm() > kFar || world_.is_hidden(place, eye);
  }

  Passer joined(const Way& before, const Way& during, const Way& after, std::size_t index) const {
    std::vector<Vector3d> places(before.places.rbegin(), before.places.rend());
    if (!places.empty()) places.pop_back();  // the first of `during` is the same
    const auto since_first = static_cast<TimeNs>(places.size());
    places.insert(places.end(), during.places.begin(), during.places.end());
    places.insert(places.end(), after.places.begin(), after.places.end());
    places.insert(places.begin(), kPad, places.front());
    places.insert(places.end(), kPad, places.back());
    const TimeNs first = span_.begin - (since_first + static_cast<TimeNs>(kPad)) * kCrowdTick;
    const TimeNs last = first + static_cast<TimeNs>(places.size() - 1) * kCrowdTick;
    const TimeNs hidden = static_cast<TimeNs>(2 * kPad - 1) * kCrowdTick;
    const TimeSpan present{before.gone ? first + hidden : -kForever,
                           after.gone ? last - hidden : kForever};
    RandomStream random(seed_, "crowd.step." + std::to_string(index));
    return {Trajectory(first + static_cast<TimeNs>(kMeanReach) * kCrowdTick, kCrowdTick,
                       smoothed(with_headings(places))),
            present, random.uniform(0, kTwoPi)};
  }

  /// People look where they go and turn about twice as fast as they would have to.
  static std::vector<PoseVector> with_headings(const std::vector<Vector3d>& places) {
    std::vector<PoseVector> out;
    double heading = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector3d& next = places[std::min(i + kMeanReach, places.size() - 1)];
      const Vector3d way = next - places[i - std::min(i, kMeanReach)];
      if (way.head<2>().norm() > 0.1) {
        const double turn = std::remainder(std::atan2(way.y(), way.x()) - heading, kTwoPi);
        heading += std::clamp(turn, -0.25, 0.25);
      }
      PoseVector pose;
      pose << places[i], heading, 0, 0;
      out.push_back(pose);
    }
    return out;
  }

  bool keeps_clear(const Passer& passer) const {
    const TimeNs begin = std::max<TimeNs>(passer.present.begin, 0);
    const TimeNs end = std::min(passer.present.end, robot_.duration());
    for (TimeNs t = begin; t < end; t += kCrowdTick) {
      const Vector3d robot = robot_.at(t).T_map_body.translation;
      const Vector3d person = passer.path.values_at(t).pose.head<3>();
      if (std::abs(robot.z() - person.z()) > 2) continue;
      if ((robot - person).head<2>().norm() < kLeastRoom) return false;
    }
    return true;
  }

  CrowdPlan plan_;
  TimeSpan span_;  ///< when it is densest
  const Drive& robot_;
  Vector3d eye_;
  const Walkers& others_;
  Walkable world_;
  std::uint64_t seed_;
};

}  // namespace

TimeSpan densest(const TimeSpan& crowd) {
  const TimeNs coming = std::min((crowd.end - crowd.begin) / 4, kComing);
  return {crowd.begin + coming, crowd.end - coming};
}

std::vector<Passer> gather_crowd(const CrowdPlan& plan, const Drive& robot, const Vector3d& eye,
                                 const Walkers& others, const RayCaster& world,
                                 std::uint64_t seed) {
  return Gathering(plan, robot, eye, others, world, seed).plan();
}

}  // namespace holdfast::simulation
