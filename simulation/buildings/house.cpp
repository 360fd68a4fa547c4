#include "simulation/buildings/house.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kEdge = 0.6;  // metres of plain wall at each end of a facade

/// One side of a house, seen from outside. Its face looks to the left of the way from `from` to
/// `to`.
class Facade {
 public:
  Facade(WorldBuilder& build, const HousePlan& plan, int side, const Vector2d& from,
         const Vector2d& to)
      : build_(build),
        plan_(plan),
        random_(plan.variant, "house." + std::to_string(side)),
        from_(from),
        to_(to),
        length_((to - from).norm()),
        step_(plan.window_step * random_.uniform(0.85, 1.2)),
        first_(kEdge + random_.uniform(0.2, 1.0) * step_),
        width_(std::min(random_.uniform(0.9, 1.7), 0.7 * step_)) {}

  void add() {
    const double top = plan_.ground + plan_.height;
    double bottom = plan_.ground;
    for (int row = 0; row < plan_.detailed_storeys && bottom + plan_.storey <= top; ++row) {
      add_row(bottom, bottom + plan_.storey, row == 0);
      bottom += plan_.storey;
    }
    if (bottom < top) build_.wall({from_, to_, bottom, top, plan_.material, {}});
    add_pillars();
  }

 private:
  void add_row(double bottom, double top, bool at_ground) {
    std::vector<WallOpening> openings;
    const double sill = random_.uniform(0.7, 1.1);
    const double high = std::min(plan_.storey - 0.3, sill + random_.uniform(1.3, 1.7));
    const double door_at = random_.uniform(0.1, 0.9) * length_;
    bool has_door = !at_ground;
    for (double at = first_; at + std::max(width_, 1.3) + kEdge <= length_;
         at += step_ * random_.uniform(0.9, 1.12)) {
      const double share = random_.uniform();
      if (!has_door && at + step_ > door_at) {
        has_door = true;
        openings.push_back(door(at, bottom));
        at += 0.6;
      } else if (share > 0.12) {
        openings.push_back({at, width_, bottom + sill, bottom + high, plan_.window_depth, false,
                            materials::kGlass});
      }
    }
    build_.wall({from_, to_, bottom, top, plan_.material, openings});
  }

  WallOpening door(double at, double bottom) {
    const double deep = random_.uniform(0.25, 0.7);
    const bool steel = random_.below(3) == 0;
    return {at,
            1.3,
            bottom,
            bottom + random_.uniform(2.1, 2.6),
            deep,
            false,
            steel ? materials::kPaintedMetal : materials::kWood};
  }

  /// Half within the wall, so that they leave no gap.
  void add_pillars() {
    const Vector2d along = (to_ - from_) / length_;
    for (int i = 0; i < plan_.pillars; ++i) {
      const double at = length_ * (i + random_.uniform(0.2, 0.8)) / plan_.pillars;
      const double wide = random_.uniform(0.25, 0.55);
      const double deep = random_.uniform(0.12, 0.32);
      const Vector2d middle = from_ + along * std::clamp(at, wide, length_ - wide);
      const double yaw = std::atan2(along.y(), along.x());
      const double high = plan_.height * (random_.below(2) == 0 ? 1.0 : 0.6);
      const Vector3d center(middle.x(), middle.y(), plan_.ground + 0.5 * high);
      build_.box({center, {wide, 2 * deep, high}, yaw}, plan_.material);
    }
  }

  WorldBuilder& build_;
  const HousePlan& plan_;
  RandomStream random_;
  Vector2d from_;
  Vector2d to_;
  double length_;
  double step_;   ///< from window to window
  double first_;  ///< where the first begins
  double width_;
};

}  // namespace

void add_house(WorldBuilder& build, const HousePlan& plan) {
  const Vector2d corners[] = {
      plan.min, {plan.min.x(), plan.max.y()}, plan.max, {plan.max.x(), plan.min.y()}};
  for (int side = 0; side < 4; ++side) {
    const Vector2d& from = corners[side];
    const Vector2d& to = corners[(side + 1) % 4];
    if ((plan.detailed_sides >> side & 1U) != 0) {
      Facade(build, plan, side, from, to).add();
    } else {
      build.wall({from, to, plan.ground, plan.ground + plan.height, plan.material, {}});
    }
  }
  build.floor(plan.min, plan.max, plan.ground + plan.height, materials::kConcrete);
}

}  // namespace holdfast::simulation
