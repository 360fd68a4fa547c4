#include "simulation/change/world_change.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "holdfast/core/random.hpp"
#include "simulation/world/ray_caster.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kLeastMove = 0.3;  // metres
constexpr double kMostMove = 2.5;
constexpr double kMostTurn = 0.6;        // rad
constexpr double kRobotClearance = 0.6;  // metres beside the robot's way, and its weaving
constexpr double kPersonClearance = 0.45;
constexpr double kWayStep = 0.1;  // metres between the places at which a way is tried
constexpr int kTries = 60;

/// Where an object is at one time: nowhere, or moved by a rigid motion over the ground.
using Place = std::optional<Eigen::Isometry3f>;

/// The world with each object at its place.
World placed(const World& world, const std::vector<Place>& places) {
  World out;
  out.vertices = world.vertices;
  out.materials = world.materials;
  out.objects = world.objects;
  out.discs = world.discs;
  for (std::size_t i = 0; i < world.triangles.size(); ++i) {
    auto triangle = world.triangles[i];
    const std::uint16_t object = world.object_of[i];
    if (object > 0) {
      const Place& place = places[object - 1U];
      if (!place) continue;
      if (!place->matrix().isIdentity(0)) {
        for (std::uint32_t& corner : triangle) {
          out.vertices.push_back(*place * world.vertices[corner]);
          corner = static_cast<std::uint32_t>(out.vertices.size() - 1);
        }
      }
    }
    out.triangles.push_back(triangle);
    out.material_of.push_back(world.material_of[i]);
    out.object_of.push_back(object);
  }
  return out;
}

std::vector<Place> places_at_first(const World& world) {
  std::vector<Place> places;
  for (const WorldObject& object : world.objects) {
    places.push_back(object.spare ? Place() : Eigen::Isometry3f::Identity());
  }
  return places;
}

World structure_of(const World& world) {
  return placed(world, std::vector<Place>(world.objects.size()));
}

/// Whoever goes there, and how much room is needed beside the middle of the way.
struct Way {
  std::vector<Vector2d> points;
  double clearance;
};

Way way_of(const Route& route, double clearance) {
  Way way{{}, clearance};
  for (double s = 0; s < route.length(); s += kWayStep) {
    way.points.emplace_back(route.at(s).position.head<2>());
  }
  return way;
}

/// Finds new places for objects.
class Rearranger {
 public:
  Rearranger(const Scenario& scenario, RandomStream& random)
      : world_(scenario.world), structure_(structure_of(scenario.world)), random_(random) {
    ways_.push_back(way_of(scenario.route, kRobotClearance + scenario.style.weave_m));
    for (const WalkerPlan& plan : scenario.walkers) {
      ways_.push_back(way_of(plan.route, kPersonClearance));
    }
    for (const VehiclePlan& plan : scenario.vehicles) {
      const double half_width = 0.5 * vehicle_size(plan.kind).y();
      ways_.push_back(way_of(plan.route, half_width + kPersonClearance));
    }
    corners_.resize(world_.objects.size());
    for (std::size_t i = 0; i < world_.triangles.size(); ++i) {
      if (world_.object_of[i] == 0) continue;
      auto& corners = corners_[world_.object_of[i] - 1U];
      for (const std::uint32_t k : world_.triangles[i]) corners.push_back(world_.vertices[k]);
    }
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      taken_.push_back(bounds(k, Eigen::Isometry3f::Identity()));
    }
  }

  /// Empty when no place was found.
  Place move(std::size_t object) {
    const AlignedBox3d here = taken_[object];
    for (int i = 0; i < kTries; ++i) {
      const Eigen::Isometry3f motion = draw(here.center());
      const AlignedBox3d there = bounds(object, motion);
      if (!is_free(object, here, there)) continue;
      taken_.push_back(there);
      return motion;
    }
    return {};
  }

 private:
  Eigen::Isometry3f draw(const Vector3d& center) {
    const double direction = random_.uniform(-M_PI, M_PI);
    const double distance = random_.uniform(kLeastMove, kMostMove);
    const Vector3d step(distance * std::cos(direction), distance * std::sin(direction), 0);
    const Eigen::AngleAxisd turn(random_.uniform(-kMostTurn, kMostTurn), Vector3d::UnitZ());
    const Vector3d foot(center.x(), center.y(), 0);
    return (Eigen::Translation3d(foot + step) * turn * Eigen::Translation3d(-foot)).cast<float>();
  }

  AlignedBox3d bounds(std::size_t object, const Eigen::Isometry3f& motion) const {
    AlignedBox3d box;
    for (const Vector3f& p : corners_[object]) box.extend((motion * p).cast<double>());
    return box;
  }

  bool is_free(std::size_t object, const AlignedBox3d& here, const AlignedBox3d& there) const {
    for (std::size_t k = 0; k < taken_.size(); ++k) {
      if (k != object && there.intersects(taken_[k])) return false;
    }
    for (const Way& way : ways_) {
      for (const Vector2d& p : way.points) {
        const AlignedBox3d level(Vector3d(there.min().x(), there.min().y(), 0),
                                 Vector3d(there.max().x(), there.max().y(), 0));
        if (level.exteriorDistance(Vector3d(p.x(), p.y(), 0)) < way.clearance) return false;
      }
    }
    return is_reachable(here, there);
  }

  /// No wall stands between the two places or within the new one, low and half-way up.
  bool is_reachable(const AlignedBox3d& here, const AlignedBox3d& there) const {
    const double low = std::min(0.06, 0.5 * there.sizes().z());
    for (const double up : {low, 0.5 * there.sizes().z()}) {
      const double z = there.min().z() + up;
      const auto at = [z](double x, double y) { return Vector3d(x, y, z).cast<float>().eval(); };
      const Vector3f corners[] = {
          at(there.min().x(), there.min().y()), at(there.max().x(), there.min().y()),
          at(there.max().x(), there.max().y()), at(there.min().x(), there.max().y())};
      const Vector3f from = at(here.center().x(), here.center().y());
      for (int k = 0; k < 4; ++k) {
        if (!structure_.is_visible(from, corners[k])) return false;
        if (!structure_.is_visible(corners[k], corners[(k + 1) % 4])) return false;
      }
    }
    return true;
  }

  const World& world_;
  RayCaster structure_;
  RandomStream& random_;
  std::vector<Way> ways_;
  std::vector<std::vector<Vector3f>> corners_;  ///< of each object's triangles
  std::vector<AlignedBox3d> taken_;             ///< first places, then new ones
};

/// `count` of the numbers below `n`, ascending.
std::vector<std::size_t> draw_some(std::size_t n, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(all[i], all[i + static_cast<std::size_t>(random.below(n - i))]);
  }
  all.resize(count);
  std::sort(all.begin(), all.end());
  return all;
}

ChangeKind draw_kind(const WorldObject& object, RandomStream& random) {
  const std::uint64_t die = random.below(6);  // always drawn: one object does not shift another
  if (object.spare) return ChangeKind::kAdded;
  if (object.mounted) return die < 3 ? ChangeKind::kRemoved : ChangeKind::kAdded;
  if (die < 2) return ChangeKind::kMoved;
  return die < 4 ? ChangeKind::kRemoved : ChangeKind::kAdded;
}

}  // namespace

World unchanged_world(const World& world) { return placed(world, places_at_first(world)); }

Result<ChangedWorld> change_world(const Scenario& scenario, double share, std::uint64_t seed) {
  const World& world = scenario.world;
  if (world.objects.empty()) {
    return Error{fmt::format("scenario '{}': nothing in its world can be changed, found no objects",
                             scenario.name)};
  }
  RandomStream random(seed, "world.change");
  const auto count =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(world.objects.size())));
  Rearranger rearranger(scenario, random);
  std::vector<Place> before = places_at_first(world);
  std::vector<Place> after = before;
  ChangedWorld out;
  for (const std::size_t object : draw_some(world.objects.size(), count, random)) {
    ChangeKind kind = draw_kind(world.objects[object], random);
    if (kind == ChangeKind::kMoved) {
      after[object] = rearranger.move(object);
      if (!after[object]) kind = ChangeKind::kRemoved;
    }
    if (kind == ChangeKind::kRemoved) after[object].reset();
    if (kind == ChangeKind::kAdded) {
      before[object].reset();
      after[object] = Eigen::Isometry3f::Identity();
    }
    out.changes.push_back({object, kind});
  }
  out.before = placed(world, before);
  out.after = placed(world, after);
  return out;
}

}  // namespace holdfast::simulation
