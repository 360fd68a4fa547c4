#include "simulation/buildings/town_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "holdfast/core/random.hpp"
#include "simulation/buildings/house.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCorner = 11.0;  // metres from a crossing's house lines that stay free of cars

/// A tree of few triangles: a stem and some clumps of leaves.
void add_street_tree(WorldBuilder& build, const Vector2d& at, RandomStream& random) {
  const double height = random.uniform(4.5, 8);
  const Vector3d foot(at.x(), at.y(), 0);
  build.cone(foot, 0.16, 0.1, 0.5 * height, materials::kWood, 8);
  for (int clump = 0; clump < 2; ++clump) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Vector3d aside(0.12 * height * std::cos(angle), 0.12 * height * std::sin(angle), 0);
    const double up = height * random.uniform(0.5, 0.75);
    const double size = height * random.uniform(0.16, 0.24);
    build.ellipsoid(foot + aside + Vector3d(0, 0, up), {size, size, 1.1 * size},
                    materials::kFoliage, 8);
  }
}

void add_lamp(WorldBuilder& build, const Vector2d& at, const Vector2d& out) {
  build.cylinder({at.x(), at.y(), 0}, 0.08, 6, materials::kPaintedMetal, 8);
  const double yaw = std::atan2(out.y(), out.x());
  const Vector2d arm = at + 0.6 * out;
  build.box({{arm.x(), arm.y(), 5.9}, {1.2, 0.12, 0.1}, yaw}, materials::kPaintedMetal);
}

/// One side of a block: a line of houses with a pavement before it.
struct Side {
  Vector2d begin;    ///< on the house line
  Vector2d along;    ///< unit
  Vector2d outward;  ///< unit, towards the street
  double length = 0;
  int index = 0;  ///< as of HousePlan's sides: west, north, east, south

  Vector2d at(double s, double out) const { return begin + s * along + out * outward; }
};

class BlockBuilder {
 public:
  BlockBuilder(WorldBuilder& build, const TownBlock& block)
      : build_(build),
        block_(block),
        random_(static_cast<std::uint64_t>(block.column) << 20 | static_cast<unsigned>(block.row),
                "town.block"),
        low_(block.min + Vector2d(kHouseLine, kHouseLine)),
        high_(block.max - Vector2d(kHouseLine, kHouseLine)) {}

  void add() {
    add_ground();
    const bool park = random_.uniform() < 0.08;
    for (const Side& side : sides()) {
      if (!park) add_houses(side);
      add_parked(side);
      add_pavement(side);
    }
    if (park) add_park();
  }

 private:
  /// The streets to the west and south, as far as the next block's.
  void add_ground() {
    const Vector2d from = block_.min - Vector2d(kHouseLine, kHouseLine);
    build_.floor(from, {high_.x(), low_.y()}, 0, materials::kAsphalt);
    build_.floor({from.x(), low_.y()}, {low_.x(), high_.y()}, 0, materials::kAsphalt);
  }

  std::vector<Side> sides() const {
    const Vector2d size = high_ - low_;
    return {{low_, Vector2d::UnitY(), -Vector2d::UnitX(), size.y(), 0},
            {{low_.x(), high_.y()}, Vector2d::UnitX(), Vector2d::UnitY(), size.x(), 1},
            {{high_.x(), low_.y()}, Vector2d::UnitY(), Vector2d::UnitX(), size.y(), 2},
            {low_, Vector2d::UnitX(), -Vector2d::UnitY(), size.x(), 3}};
  }

  /// Houses of different fronts, heights and setbacks, some with a gap or a yard between them.
  void add_houses(const Side& side) {
    const bool between = side.index % 2 == 0;  // the other two sides go round the corners
    const double margin = between ? 12 : 0;
    double s = margin;
    while (s + 7 < side.length - margin) {
      const double left = side.length - margin - s;
      double front = random_.uniform(8, 19);
      if (left - front < 7) front = left;
      add_house_at(side, s, front);
      s += front + (random_.uniform() < 0.35 ? random_.uniform(1.5, 6) : 0);
    }
  }

  void add_house_at(const Side& side, double s, double front) {
    const double setback = random_.uniform() < 0.5 ? 0 : random_.uniform(0.2, 1.6);
    const double deep = random_.uniform(9, 12);
    const Vector2d a = side.at(s, -setback);
    const Vector2d b = side.at(s + front, -setback - deep);
    HousePlan plan;
    plan.min = a.cwiseMin(b);
    plan.max = a.cwiseMax(b);
    plan.height = random_.uniform(5.5, 15);
    plan.storey = random_.uniform(3.0, 3.8);
    plan.window_step = random_.uniform(2.6, 4.6);
    plan.window_depth = random_.uniform(0.1, 0.35);
    plan.pillars = static_cast<int>(random_.below(4));
    plan.detailed_storeys = 1 + static_cast<int>(random_.below(2));
    plan.detailed_sides = 1U << side.index;
    plan.variant = static_cast<unsigned>(random_.below(1U << 30));
    static constexpr std::array kMaterials = {materials::kBrick, materials::kPlaster,
                                              materials::kConcrete};
    plan.material = kMaterials[random_.below(kMaterials.size())];
    add_house(build_, plan);
  }

  void add_parked(const Side& side) {
    const double out = kHouseLine - kParkingMiddle;
    const double yaw = std::atan2(side.along.y(), side.along.x());
    for (double s = kCorner; s + kCorner < side.length; s += random_.uniform(5.6, 7.5)) {
      const double share = random_.uniform();
      const Placement place{
          side.at(s, out + random_.uniform(-0.12, 0.12)),
          yaw + random_.uniform(-0.04, 0.04) + (random_.below(2) == 0 ? 0 : std::numbers::pi)};
      if (share < 0.4) add_car(build_, place);
      if (share > 0.97) build_.spare([&] { add_car(build_, place); });
      if (share > 0.4 && share < 0.44) {
        add_crate(build_, place, {random_.uniform(2, 5), 1.8, random_.uniform(1.2, 2.4)},
                  materials::kPaintedMetal);
      }
    }
  }

  void add_pavement(const Side& side) {
    for (double s = random_.uniform(2, 9); s < side.length; s += random_.uniform(6, 16)) {
      const double share = random_.uniform();
      const double yaw = std::atan2(side.outward.y(), side.outward.x());
      if (share < 0.3) add_street_tree(build_, side.at(s, 1.7), random_);
      if (share > 0.4 && share < 0.65) add_lamp(build_, side.at(s, 1.9), side.outward);
      if (share > 0.8) {
        const Vector3d size(random_.uniform(0.3, 0.6), random_.uniform(0.5, 1.4),
                            random_.uniform(0.9, 1.5));
        add_crate(build_, {side.at(s, 0.5), yaw}, size, materials::kPaintedMetal);
      }
    }
  }

  void add_park() {
    build_.floor(low_, high_, 0.02, materials::kGrass);
    const Vector2d size = high_ - low_;
    for (int i = 0; i < 14; ++i) {
      const Vector2d share(random_.uniform(0.06, 0.94), random_.uniform(0.06, 0.94));
      add_street_tree(build_, low_ + share.cwiseProduct(size), random_);
    }
    const Vector2d middle = low_ + size * random_.uniform(0.35, 0.65);
    build_.box({{middle.x(), middle.y(), 1.5}, {random_.uniform(4, 9), 4, 3}, 0.2},
               materials::kWood);
  }

  WorldBuilder& build_;
  const TownBlock& block_;
  RandomStream random_;
  Vector2d low_;
  Vector2d high_;
};

}  // namespace

void add_town_block(WorldBuilder& build, const TownBlock& block) {
  BlockBuilder(build, block).add();
}

}  // namespace holdfast::simulation
