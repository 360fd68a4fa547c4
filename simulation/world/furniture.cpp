#include "simulation/world/furniture.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d in_map(const Placement& place, const Vector3d& p) {
  const Eigen::Rotation2Dd turn(place.yaw);
  const Vector2d xy = place.at + turn * p.head<2>();
  return {xy.x(), xy.y(), p.z()};
}

/// A box whose bottom centre is at `p` in the frame of the placement.
void stand(WorldBuilder& build, const Placement& place, const Vector3d& p, const Vector3d& size,
           const Material& material) {
  const Vector3d center = p + Vector3d(0, 0, 0.5 * size.z());
  build.box({in_map(place, center), size, place.yaw}, material);
}

}  // namespace

void add_desk(WorldBuilder& build, const Placement& place) {
  build.object({"desk"}, [&] {
    stand(build, place, {0, 0, 0.71}, {0.75, 1.4, 0.03}, materials::kWood);
    for (const double side : {-1.0, 1.0}) {
      stand(build, place, {0, side * 0.67, 0}, {0.65, 0.03, 0.71}, materials::kPaintedMetal);
    }
    stand(build, place, {-0.03, 0.43, 0.05}, {0.58, 0.42, 0.55}, materials::kPaintedMetal);
    stand(build, place, {0.2, 0, 0.74}, {0.18, 0.2, 0.02}, materials::kPaintedMetal);
    stand(build, place, {0.22, 0, 0.82}, {0.05, 0.55, 0.34}, materials::kPaintedMetal);
  });
}

void add_chair(WorldBuilder& build, const Placement& place) {
  build.object({"chair"}, [&] {
    for (int leg = 0; leg < 5; ++leg) {
      const Placement turned{place.at, place.yaw + leg * 2 * std::numbers::pi / 5};
      stand(build, turned, {0.15, 0, 0.04}, {0.3, 0.04, 0.04}, materials::kPaintedMetal);
    }
    build.cylinder(in_map(place, {0, 0, 0.08}), 0.03, 0.36, materials::kPaintedMetal, 12);
    stand(build, place, {0, 0, 0.44}, {0.46, 0.46, 0.08}, materials::kFabric);
    stand(build, place, {-0.22, 0, 0.58}, {0.06, 0.42, 0.45}, materials::kFabric);
  });
}

void add_table(WorldBuilder& build, const Placement& place, double length) {
  build.object({"table"}, [&] {
    stand(build, place, {0, 0, 0.71}, {0.9, length, 0.03}, materials::kWood);
    for (const double x : {-0.4, 0.4}) {
      for (const double y : {-0.5 * length + 0.06, 0.5 * length - 0.06}) {
        stand(build, place, {x, y, 0}, {0.05, 0.05, 0.71}, materials::kPaintedMetal);
      }
    }
  });
}

void add_plain_chair(WorldBuilder& build, const Placement& place) {
  build.object({"chair"}, [&] {
    for (const double x : {-0.19, 0.19}) {
      for (const double y : {-0.19, 0.19}) {
        stand(build, place, {x, y, 0}, {0.035, 0.035, 0.44}, materials::kWood);
      }
    }
    stand(build, place, {0, 0, 0.44}, {0.42, 0.42, 0.03}, materials::kWood);
    for (const double y : {-0.19, 0.19}) {
      stand(build, place, {-0.19, y, 0.47}, {0.035, 0.035, 0.42}, materials::kWood);
    }
    stand(build, place, {-0.19, 0, 0.68}, {0.02, 0.345, 0.2}, materials::kWood);
  });
}

void add_shelf(WorldBuilder& build, const Placement& place, double width, double height,
               unsigned variant) {
  constexpr double kBoardStep = 0.38;
  constexpr double kThick = 0.02;
  RandomStream random(variant, "shelf");
  const double inside = width - 2 * kThick;
  build.object({"shelf"}, [&] {
    for (const double side : {-1.0, 1.0}) {
      stand(build, place, {0, side * 0.5 * (width - kThick), 0}, {0.35, kThick, height},
            materials::kWood);
    }
    for (double z = 0.06; z < height; z += kBoardStep) {
      stand(build, place, {0, 0, z}, {0.35, inside, kThick}, materials::kWood);
      const double filled = inside * random.uniform(0.3, 1.0);
      const double high = random.uniform(0.22, 0.32);
      if (z + kThick + high > height) continue;
      stand(build, place, {-0.02, 0.5 * (filled - inside), z + kThick}, {0.27, filled, high},
            materials::kCardboard);
    }
  });
}

void add_plant(WorldBuilder& build, const Vector2d& at) {
  build.object({"plant"}, [&] {
    build.cylinder({at.x(), at.y(), 0}, 0.2, 0.5, materials::kConcrete, 24);
    build.ellipsoid({at.x(), at.y(), 0.95}, {0.35, 0.35, 0.45}, materials::kFoliage);
  });
}

void add_crate(WorldBuilder& build, const Placement& place, const Vector3d& size,
               const Material& material) {
  build.object({"crate"}, [&] { stand(build, place, {0, 0, 0}, size, material); });
}

void add_bench(WorldBuilder& build, const Placement& place, double length) {
  build.object({"bench"}, [&] {
    stand(build, place, {0, 0, 0.39}, {0.45, length, 0.06}, materials::kWood);
    for (const double side : {-0.4, 0.4}) {
      stand(build, place, {0, side * length, 0}, {0.35, 0.1, 0.39}, materials::kConcrete);
    }
  });
}

void add_cabinet(WorldBuilder& build, const Placement& place, double width, double height,
                 const Material& material) {
  build.object({"cabinet"}, [&] {
    stand(build, place, {-0.02, 0, 0}, {0.38, width - 0.02, 0.08}, materials::kPaintedMetal);
    stand(build, place, {0, 0, 0.08}, {0.42, width, height - 0.08}, material);
  });
}

void add_partition(WorldBuilder& build, const Placement& place, double length, double height) {
  build.object({"partition"}, [&] {
    stand(build, place, {0, 0, 0.05}, {0.04, length, height - 0.05}, materials::kFabric);
  });
}

void add_wall_box(WorldBuilder& build, const Placement& place, double bottom, const Vector3d& size,
                  const Material& material) {
  build.object({"wall box", true}, [&] {
    stand(build, place, {0.5 * size.x(), 0, bottom}, size, material);
  });
}

void add_tree(WorldBuilder& build, const Vector2d& at, double height, int shape) {
  RandomStream random(static_cast<std::uint64_t>(shape), "tree");
  const double stem = height * random.uniform(0.28, 0.4);
  const double thick = 0.018 * height * random.uniform(0.8, 1.3);
  const Vector3d foot(at.x(), at.y(), 0);
  build.cone(foot, 1.25 * thick, 0.8 * thick, stem + 0.2 * height, materials::kWood, 16);
  const int clumps = 4 + static_cast<int>(random.below(3));
  for (int i = 0; i < clumps; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform()) / clumps;
    const double out = height * random.uniform(0.06, 0.14);
    const double up = stem + height * random.uniform(0.12, 0.42);
    const Vector3d center = foot + Vector3d(out * std::cos(angle), out * std::sin(angle), up);
    const double size = height * random.uniform(0.13, 0.2);
    build.ellipsoid(center, size * Vector3d(1, 1, random.uniform(0.8, 1.1)), materials::kFoliage);
  }
}

void add_pole(WorldBuilder& build, const Placement& place, double height) {
  build.cylinder(in_map(place, {0, 0, 0}), 0.07, height, materials::kPaintedMetal, 16);
  stand(build, place, {0.6, 0, height - 0.1}, {1.2, 0.12, 0.1}, materials::kPaintedMetal);
  build.cylinder(in_map(place, {0, 0, 0}), 0.16, 0.35, materials::kConcrete, 16);
}

void add_car(WorldBuilder& build, const Placement& place) {
  build.object({"car"}, [&] {
    for (const double x : {-1.35, 1.35}) {
      for (const double y : {-0.75, 0.75}) {
        stand(build, place, {x, y, 0}, {0.6, 0.2, 0.6}, materials::kFabric);
      }
    }
    stand(build, place, {0, 0, 0.25}, {4.4, 1.75, 0.6}, materials::kPaintedMetal);
    stand(build, place, {-0.25, 0, 0.85}, {2.3, 1.5, 0.55}, materials::kPaintedMetal);
  });
}

void add_rack(WorldBuilder& build, const Placement& place, const RackPlan& plan) {
  constexpr double kDepth = 1.1;
  RandomStream random(plan.variant, "rack");
  const double height = plan.levels * plan.level_height;
  const double begin = -0.5 * plan.bays * plan.bay;
  for (int post = 0; post <= plan.bays; ++post) {
    for (const double x : {-0.5 * kDepth, 0.5 * kDepth}) {
      stand(build, place, {x, begin + post * plan.bay, 0}, {0.08, 0.1, height},
            materials::kPaintedMetal);
    }
  }
  for (int level = 0; level < plan.levels; ++level) {
    const double z = level * plan.level_height;
    for (const double x : {-0.5 * kDepth, 0.5 * kDepth}) {
      if (level == 0) break;
      stand(build, place, {x, 0, z - 0.12}, {0.05, plan.bays * plan.bay, 0.12},
            materials::kPaintedMetal);
    }
    for (int slot = 0; slot < 2 * plan.bays; ++slot) {
      const double y = begin + (slot + 0.5) * 0.5 * plan.bay;
      const double load = random.uniform(0.4, plan.level_height - 0.35);
      const double width = random.uniform(0.8, 1.15);
      const double depth = random.uniform(0.8, 1.1);
      const double aside = random.uniform(-0.06, 0.06);
      if (random.uniform() < 0.18) continue;
      build.object({"load", true}, [&] {
        stand(build, place, {aside, y, z}, {1.0, 1.2, 0.14}, materials::kWood);
        stand(build, place, {aside, y, z + 0.14}, {depth, width, load}, materials::kCardboard);
      });
    }
  }
}

}  // namespace holdfast::simulation
