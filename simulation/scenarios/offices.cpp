#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kQuarter = 0.5 * std::numbers::pi;
const Vector2d kSize(40, 25);
constexpr double kHeight = 2.75;
constexpr double kHalfWall = 0.06;
constexpr double kDoorHeight = 2.1;

// The ring of corridors lies between these two rectangles (middles of the walls).
const Vector2d kRingMin(6.2, 6.2);
const Vector2d kRingMax(33.8, 18.8);
const Vector2d kCoreMin(8.6, 8.6);
const Vector2d kCoreMax(31.4, 16.4);

/// A door in the middle of a wall between two rooms.
struct Door {
  Vector2d at;
  double width = 0.95;
  bool open = true;
};

const std::vector<Door>& doors() {
  static const std::vector<Door> kDoors = {
      // south rooms
      {{4.9, 6.2}, 0.95, false},
      {{9.3, 6.2}},
      {{15, 6.2}, 1.3},
      {{25, 6.2}, 1.3},
      {{30.1, 6.2}},
      // north rooms
      {{8.4, 18.8}},
      {{13, 18.8}, 1.3},
      {{21, 18.8}, 1.3},
      {{25.2, 18.8}, 0.95, false},
      {{31.6, 18.8}},
      // west and east rooms
      {{6.2, 9.9}},
      {{6.2, 16.8}, 0.95, false},
      {{33.8, 8.1}},
      {{33.8, 12.6}},
      {{33.8, 17.2}, 0.95, false},
      // core: a meeting room, a kitchen open to the south, a store
      {{10.1, 8.6}},
      {{18, 8.6}, 4.2},
      {{25.6, 16.4}, 0.95, false},
      {{31.4, 11.0}},
      {{12.3, 16.4}, 0.95, false}};
  return kDoors;
}

/// One face of a wall with the doors that stand in it, at most a wall's thickness away.
void add_face(WorldBuilder& build, const Vector2d& from, const Vector2d& to,
              std::vector<WallOpening> openings = {}) {
  const double length = (to - from).norm();
  const Vector2d along = (to - from) / length;
  const Vector2d aside(-along.y(), along.x());
  for (const Door& door : doors()) {
    const double middle = along.dot(door.at - from);
    if (std::abs(aside.dot(door.at - from)) > 2 * kHalfWall) continue;
    if (middle < 0 || middle > length) continue;
    const double depth = door.open ? kHalfWall : 0.03;
    openings.push_back({middle - 0.5 * door.width, door.width, 0, kDoorHeight, depth, door.open,
                        materials::kWood});
  }
  build.wall({from, to, 0, kHeight, materials::kPlaster, openings});
}

/// The four faces of a room seen from within, given the middles of its walls; the outer walls of
/// the floor have no thickness.
struct Room {
  Vector2d min;
  Vector2d max;

  Room(const Vector2d& low, const Vector2d& high) : min(low), max(high) {
    for (int k = 0; k < 2; ++k) {
      if (min[k] > 0) min[k] += kHalfWall;
      if (max[k] < kSize[k]) max[k] -= kHalfWall;
    }
  }
  Vector2d size() const { return max - min; }
};

/// Windows at uneven distances over an outer wall of this length.
std::vector<WallOpening> windows(double length, double first) {
  std::vector<WallOpening> out;
  for (double at = first; at + 1.5 < length - 0.3; at += 1.95 + 0.15 * std::sin(7 * at)) {
    out.push_back({at, 1.5, 0.9, 2.2, 0.15, false, materials::kFabric});
  }
  return out;
}

void add_room(WorldBuilder& build, const Room& room) {
  const Vector2d corners[] = {
      room.min, {room.max.x(), room.min.y()}, room.max, {room.min.x(), room.max.y()}};
  for (int i = 0; i < 4; ++i) {
    const Vector2d& from = corners[i];
    const Vector2d& to = corners[(i + 1) % 4];
    const bool south = i == 0 && from.y() == 0;
    const bool north = i == 2 && from.y() == kSize.y();
    const double first = 0.5 + 0.06 * from.x();
    add_face(build, from, to,
             south || north ? windows((to - from).norm(), std::fmod(first, 0.9) + 0.4)
                            : std::vector<WallOpening>());
  }
}

/// Both sides of the ring of corridors.
void add_ring(WorldBuilder& build) {
  const Vector2d out_min = kRingMin + Vector2d::Constant(kHalfWall);
  const Vector2d out_max = kRingMax - Vector2d::Constant(kHalfWall);
  const Vector2d in_min = kCoreMin - Vector2d::Constant(kHalfWall);
  const Vector2d in_max = kCoreMax + Vector2d::Constant(kHalfWall);
  const Vector2d outer[] = {
      out_min, {out_max.x(), out_min.y()}, out_max, {out_min.x(), out_max.y()}};
  const Vector2d inner[] = {in_min, {in_min.x(), in_max.y()}, in_max, {in_max.x(), in_min.y()}};
  for (int i = 0; i < 4; ++i) {
    add_face(build, outer[i], outer[(i + 1) % 4]);
    add_face(build, inner[i], inner[(i + 1) % 4]);
  }
}

/// Seen from its door a room goes `depth` ahead (+x) and `half` to each side of `middle`.
struct Furnished {
  Vector2d middle;  ///< of the wall with the door
  double yaw;       ///< from there into the room
  double depth;
  double half;
  unsigned variant;

  Placement at(double x, double y, double turn = 0) const {
    return {middle + Eigen::Rotation2Dd(yaw) * Vector2d(x, y), yaw + turn};
  }
};

/// One or two places to work, a cabinet, a shelf.
void furnish_office(WorldBuilder& build, const Furnished& room) {
  const double turn = 0.1 * (room.variant % 5) - 0.2;
  const double desk = room.depth - 1.15 - 0.1 * (room.variant % 3);
  add_desk(build, room.at(desk, room.half - 0.85, 0));
  add_chair(build, room.at(desk - 0.75, room.half - 0.9, turn));
  if (room.variant % 3 != 0) {
    add_desk(build, room.at(desk, 0.85 - room.half, 0));
    add_chair(build, room.at(desk - 0.8, 0.95 - room.half, -turn));
  }
  const double cabinet = 1.1 + 0.17 * (room.variant % 4);
  add_cabinet(build, room.at(cabinet, room.half - 0.23, -kQuarter), 0.9,
              room.variant % 2 == 0 ? 1.9 : 1.2);
  add_shelf(build, room.at(cabinet + 0.4, 0.2 - room.half, kQuarter),
            0.9 + 0.1 * (room.variant % 3), 1.85, room.variant);
  if (room.variant % 2 == 1) add_plant(build, room.at(room.depth - 0.45, 0.0).at);
}

void furnish_meeting_room(WorldBuilder& build, const Furnished& room) {
  const double x = 0.5 * room.depth + 0.2;
  add_table(build, room.at(x, 0.1, 0.02), 2.4);
  for (int i = 0; i < 3; ++i) {
    const double y = -0.8 + 0.85 * i;
    const double turn = 0.15 * std::sin(3.0 * i + room.variant);
    add_plain_chair(build, room.at(x - 0.72, y, turn));
    add_plain_chair(build, room.at(x + 0.72, y + 0.1, 2 * kQuarter - turn));
  }
  const Placement board = room.at(room.depth, 0.3, 2 * kQuarter);
  add_wall_box(build, board, 0.9, {0.04, 1.8, 1.1}, materials::kPaintedMetal);
}

/// The room of many desks in the south; the robot goes along y = 3.
void furnish_open_plan(WorldBuilder& build) {
  for (const double x : {16.6, 20.3, 23.6}) {
    add_desk(build, {{x - 0.4, 1.1}, 0});
    add_desk(build, {{x + 0.4, 1.15}, 2 * kQuarter});
    add_partition(build, {{x, 1.1}, 0}, 1.5, 1.3);
    add_chair(build, {{x - 1.1, 1.15}, 0.3});
    add_chair(build, {{x + 1.12, 1.0}, 2 * kQuarter + 0.2});
  }
  for (const double x : {17.9, 21.4}) {
    add_desk(build, {{x, 4.95}, kQuarter});
    add_plain_chair(build, {{x + 0.1, 4.25}, kQuarter - 0.1});
  }
  for (const double x : {16.3, 19.7, 23.1}) add_cabinet(build, {{x, 5.9}, -kQuarter}, 1.1, 1.3);
  add_shelf(build, {{13.26, 2.4}, 0}, 1.8, 1.85, 31);
  add_plant(build, {13.6, 0.6});
}

/// The library in the north; the robot goes along y = 21.7.
void furnish_library(WorldBuilder& build) {
  unsigned variant = 40;
  for (const double x : {12.2, 14.4, 16.3, 19.5, 21.8}) {
    add_shelf(build, {{x, 24.78}, -kQuarter}, 1.6, 2.1, variant++);
  }
  for (const double x : {15.2, 17.0, 18.9}) {
    add_shelf(build, {{x, 19.1}, kQuarter}, 1.4, 1.5, variant++);
  }
  add_table(build, {{17.2, 23.4}, kQuarter}, 2.0);
  for (const double x : {16.5, 17.4, 18.0}) {
    add_plain_chair(build, {{x, 24.1}, -kQuarter + 0.2 * (x - 17)});
  }
  add_plant(build, {22.5, 19.3});
}

void furnish_core(WorldBuilder& build) {
  furnish_meeting_room(build, {{10.9, kCoreMin.y()}, kQuarter, 7.8, 2.3, 3});
  add_cabinet(build, {{17.0, 16.1}, -kQuarter}, 2.4, 0.9);  // the kitchen's sideboard
  add_cabinet(build, {{19.9, 16.1}, -kQuarter}, 1.2, 2.0);
  add_table(build, {{15.2, 14.0}, 0}, 1.6);
  add_plain_chair(build, {{14.45, 13.7}, 0.1});
  add_plain_chair(build, {{15.95, 14.3}, 2 * kQuarter});
  add_table(build, {{20.6, 13.6}, 0.05}, 1.2);
  add_plain_chair(build, {{19.85, 13.6}, 0.2});
  for (const double y : {10.2, 12.0, 13.9}) {
    add_shelf(build, {{29.6 - 0.3 * y, y}, 0}, 1.6, 1.85, static_cast<unsigned>(y));
  }
}

/// What stands and hangs in the corridors, off everybody's way.
void furnish_corridors(WorldBuilder& build) {
  const auto on_south = [&](double x, double width, double bottom, double height) {
    add_wall_box(build, {{x, kRingMin.y() + kHalfWall}, kQuarter}, bottom, {0.04, width, height},
                 materials::kFabric);
  };
  on_south(12.1, 1.2, 1.0, 0.9);
  on_south(19.4, 1.8, 0.9, 1.1);
  on_south(28.0, 0.6, 1.1, 0.5);
  const Placement hydrant{{kRingMax.x() - kHalfWall, 15.4}, 2 * kQuarter};
  add_wall_box(build, hydrant, 0.6, {0.16, 0.5, 0.7}, materials::kPaintedMetal);
  const Placement notices{{kRingMin.x() + kHalfWall, 13.4}, 0};
  add_wall_box(build, notices, 0.9, {0.03, 1.4, 1.0}, materials::kFabric);
  const Placement screen{{17.5, kRingMax.y() - kHalfWall}, -kQuarter};
  add_wall_box(build, screen, 1.1, {0.06, 1.3, 0.75}, materials::kPaintedMetal);
  add_plant(build, {33.35, 18.4});
  add_plant(build, {6.62, 6.62});
}

void add_rooms(WorldBuilder& build) {
  const double w = kSize.x();
  const double h = kSize.y();
  const double south = kRingMin.y();
  const double north = kRingMax.y();
  const double west = kRingMin.x();
  const double east = kRingMax.x();
  unsigned variant = 0;
  const auto office = [&](const Vector2d& min, const Vector2d& max, double yaw) {
    const Room room(min, max);
    add_room(build, room);
    const Vector2d into(std::cos(yaw), std::sin(yaw));
    const bool upright = std::abs(into.y()) > 0.5;
    const double depth = upright ? room.size().y() : room.size().x();
    const double half = 0.5 * (upright ? room.size().x() : room.size().y());
    const Vector2d middle = 0.5 * (room.min + room.max) - 0.5 * depth * into;
    furnish_office(build, {middle, yaw, depth, half, variant++});
  };
  const auto bare = [&](const Vector2d& min, const Vector2d& max) {
    add_room(build, Room(min, max));
  };
  office({0, 0}, {6.2, south}, -kQuarter);
  office({6.2, 0}, {13, south}, -kQuarter);
  bare({13, 0}, {27, south});
  office({27, 0}, {33.8, south}, -kQuarter);
  office({33.8, 0}, {w, south}, -kQuarter);
  office({0, north}, {6.2, h}, kQuarter);
  office({6.2, north}, {11, h}, kQuarter);
  bare({11, north}, {23, h});
  office({23, north}, {28, h}, kQuarter);
  office({28, north}, {33.8, h}, kQuarter);
  office({33.8, north}, {w, h}, kQuarter);
  office({0, south}, {west, 12.5}, 2 * kQuarter);
  office({0, 12.5}, {west, north}, 2 * kQuarter);
  office({east, south}, {w, 10.5}, 0);
  office({east, 10.5}, {w, 14.8}, 0);
  office({east, 14.8}, {w, north}, 0);
  for (const Vector2d& x : {Vector2d(8.6, 13.2), Vector2d(13.2, 23), Vector2d(23, 31.4)}) {
    bare({x.x(), kCoreMin.y()}, {x.y(), kCoreMax.y()});
  }
}

Route rectangle(const Vector2d& min, const Vector2d& max, double radius) {
  return Route::closed(
      {{min.x(), min.y()}, {max.x(), min.y()}, {max.x(), max.y()}, {min.x(), max.y()}}, radius);
}

}  // namespace

// A floor of an office building. The robot keeps to the outer side of the ring and passes through
// the open-plan room in the south and the library in the north; people walk on the inner side, in
// the rooms and across.
Scenario make_offices() {
  WorldBuilder build;
  build.floor({0, 0}, kSize, 0, materials::kCarpet);
  build.ceiling({0, 0}, kSize, kHeight, materials::kCeilingTile);
  add_ring(build);
  add_rooms(build);
  furnish_open_plan(build);
  furnish_library(build);
  furnish_core(build);
  furnish_corridors(build);

  Scenario scenario;
  scenario.name = "offices";
  scenario.world = build.build();
  scenario.route = Route::closed({{7.1, 7.1},
                                  {15, 7.1},
                                  {15, 3.0},
                                  {25, 3.0},
                                  {25, 7.1},
                                  {32.9, 7.1},
                                  {32.9, 17.9},
                                  {21, 17.9},
                                  {21, 21.7},
                                  {13, 21.7},
                                  {13, 17.9},
                                  {7.1, 17.9}},
                                 0.8);
  scenario.style.distance_m = 170;
  scenario.style.weave_m = 0.05;
  scenario.walkers = {{rectangle({9.5, 7.9}, {30.5, 8.2}, 0.15), 0.9},
                      {rectangle({9.5, 16.8}, {30.5, 17.1}, 0.15), 0.8},
                      {rectangle({31.8, 9.5}, {32.1, 16.0}, 0.15), 0.7},
                      {rectangle({7.9, 9.5}, {8.2, 15.5}, 0.15), 0.8},
                      {rectangle({16.6, 9.6}, {19.2, 12.6}, 0.5), 0.7},
                      {rectangle({26.0, 0.8}, {26.5, 5.5}, 0.25), 0.6},
                      {rectangle({17.6, 6.9}, {18.2, 11.5}, 0.3), 0.9}};
  return scenario;
}

}  // namespace holdfast::simulation
