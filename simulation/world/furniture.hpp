#pragma once

#include "simulation/world/world_builder.hpp"

/// Things that stand in worlds, made of the builder's solids. `at` is where they stand on the
/// ground, `yaw` turns them about the vertical; what has a front faces along +x before it is
/// turned. All but trees, poles and racks are objects of the world, and so is each load of a rack.
namespace holdfast::simulation {

struct Placement {
  Eigen::Vector2d at;
  double yaw = 0;
};

/// Desk of 1.4 x 0.75 m, 0.74 m high, with two side panels, drawers and a monitor; long side along
/// y.
void add_desk(WorldBuilder& build, const Placement& place);

/// Office chair: five-legged base, post, seat and back.
void add_chair(WorldBuilder& build, const Placement& place);

/// Table of `length` (along y) x 0.9 m on four legs.
void add_table(WorldBuilder& build, const Placement& place, double length);

/// Wooden chair on four legs.
void add_plain_chair(WorldBuilder& build, const Placement& place);

/// Open shelf 0.35 m deep (along x): two sides and boards, on which `variant` puts folders.
void add_shelf(WorldBuilder& build, const Placement& place, double width, double height,
               unsigned variant);

/// Pot with a bush, 1.4 m high.
void add_plant(WorldBuilder& build, const Eigen::Vector2d& at);

/// Something closed that is put down somewhere: a crate, a stack of boxes, a container.
void add_crate(WorldBuilder& build, const Placement& place, const Eigen::Vector3d& size,
               const Material& material = materials::kCardboard);

/// Bench without a back, 0.45 m high; long side along y.
void add_bench(WorldBuilder& build, const Placement& place, double length);

/// Closed cabinet with a plinth; depth along x, width along y.
void add_cabinet(WorldBuilder& build, const Placement& place, double width, double height,
                 const Material& material = materials::kWood);

/// Upright panel 4 cm thick; length along y.
void add_partition(WorldBuilder& build, const Placement& place, double length, double height);

/// Flat thing on a wall, such as a notice board or a fire cabinet: `at` lies on the wall, +x points
/// away from it.
void add_wall_box(WorldBuilder& build, const Placement& place, double bottom,
                  const Eigen::Vector3d& size, const Material& material);

/// Deciduous tree: trunk and a crown of a few overlapping ellipsoids. `shape` varies the crown.
void add_tree(WorldBuilder& build, const Eigen::Vector2d& at, double height, int shape);

/// Lamp post or sign: a pole with an arm.
void add_pole(WorldBuilder& build, const Placement& place, double height);

/// Parked car, 4.4 m long along x.
void add_car(WorldBuilder& build, const Placement& place);

/// Pallet rack: uprights every `bay` metres along y, two uprights deep (1.1 m along x), beams at
/// each level, loads on most places as `variant` decides.
struct RackPlan {
  int bays = 10;
  double bay = 2.7;
  int levels = 3;
  double level_height = 1.7;
  unsigned variant = 0;
};
void add_rack(WorldBuilder& build, const Placement& place, const RackPlan& plan);

}  // namespace holdfast::simulation
