#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulation/scenarios/all.hpp"
#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLength = 200;
constexpr double kHalfWidth = 4.5;
constexpr double kSpring = 2.8;  // height at which the vault begins
constexpr double kRise = 2.6;    // of the vault above that
constexpr int kFacets = 14;      // of the vault, 13 degrees each
constexpr double kKerbWidth = 0.6;
constexpr double kKerbHeight = 0.2;
constexpr double kStep = 2.5;         // metres of tube made of flat pieces
constexpr double kCurveBegin = 70;    // along the axis
constexpr double kCurveRadius = 350;  // to the left
constexpr double kCurveTurn = 0.2;    // rad
constexpr double kCurveEnd = kCurveBegin + kCurveRadius * kCurveTurn;
constexpr double kForecourt = 24;  // metres of open road before each portal
constexpr double kForecourtHalfWidth = 7;
constexpr double kFaceHeight = 7;  // of the wall that a portal stands in
constexpr double kLane = 2;        // metres from the axis to the middle of a lane
constexpr double kTurning = 8;     // metres before the portal where robots turn round

/// A place on the axis of the tube; y counts to the left of it.
struct Section {
  Vector2d origin;
  double heading;

  Vector2d at(double y) const {
    return origin + y * Vector2d(-std::sin(heading), std::cos(heading));
  }
  Vector3d at(double y, double z) const {
    const Vector2d xy = at(y);
    return {xy.x(), xy.y(), z};
  }
};

/// Straight, a bend to the left, straight.
Section section(double s) {
  const double bend = std::clamp(s, kCurveBegin, kCurveEnd) - kCurveBegin;
  const double turn = bend / kCurveRadius;
  const double rest = std::max(s - kCurveEnd, 0.0);
  const Vector2d arc(kCurveRadius * std::sin(turn), kCurveRadius * (1 - std::cos(turn)));
  const Vector2d ahead(std::cos(turn), std::sin(turn));
  return {Vector2d(std::min(s, kCurveBegin), 0) + arc + rest * ahead, turn};
}

/// Where the two straights of a lane would meet.
Vector2d lane_corner(double y) {
  const double ahead = (kCurveRadius - y) * std::tan(0.5 * kCurveTurn);
  return {kCurveBegin + ahead, y};
}

/// A hole in the wall, which fits into the piece of wall that begins at or before `s`.
struct Recess {
  double s;
  bool left;
  WallOpening opening;
};

WallOpening door() { return {0, 1.1, kKerbHeight, 2.3, 0.12, false, materials::kPaintedMetal}; }
WallOpening niche() { return {0, 1.3, kKerbHeight, 2.2, 0.35, false, materials::kConcrete}; }

// From 75 to 145 m the tube is bare, and what is nearest beside that stands back in the wall: seen
// from the 30 m in the middle (95 to 125 m) next to nothing stops a slip along the axis.
std::vector<Recess> recesses() {
  return {{24.4, false, door()}, {62.9, true, niche()},   {73.2, false, door()},
          {145.6, true, door()}, {157.8, false, niche()}, {191.0, false, door()}};
}

/// One side of the tube between two sections, seen from within.
void add_wall(WorldBuilder& build, double s, bool left, const std::vector<Recess>& holes) {
  const Section from = section(left ? s + kStep : s);
  const Section to = section(left ? s : s + kStep);
  const double y = left ? kHalfWidth : -kHalfWidth;
  WallPlan wall{from.at(y), to.at(y), 0, kSpring, materials::kConcrete, {}};
  for (const Recess& hole : holes) {
    if (hole.left != left || hole.s < s || hole.s >= s + kStep) continue;
    wall.openings.push_back(hole.opening);
    wall.openings.back().start = std::min(hole.s - s, kStep - hole.opening.width - 0.1);
  }
  // On the right a wall runs with the axis and is seen from its left; on the left, against it.
  build.wall(wall);
}

/// Height and distance from the axis of the vault's corners, from right to left.
std::array<Vector2d, kFacets + 1> vault() {
  std::array<Vector2d, kFacets + 1> corners;
  for (int i = 0; i <= kFacets; ++i) {
    const double angle = std::numbers::pi * i / kFacets;
    corners[static_cast<std::size_t>(i)] = {-kHalfWidth * std::cos(angle),
                                            kSpring + kRise * std::sin(angle)};
  }
  return corners;
}

void add_vault(WorldBuilder& build, const Section& from, const Section& to) {
  const auto corners = vault();
  for (std::size_t i = 0; i < kFacets; ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[i + 1];
    build.quad(from.at(a.x(), a.y()), to.at(a.x(), a.y()), to.at(b.x(), b.y()),
               from.at(b.x(), b.y()), materials::kConcrete);
  }
}

/// A strip of ground between two sections, from y0 on the right to y1 on the left.
void add_strip(WorldBuilder& build, const Section& from, const Section& to, double y0, double y1,
               double z, const Material& material) {
  build.quad(from.at(y0, z), to.at(y0, z), to.at(y1, z), from.at(y1, z), material);
}

void add_ground(WorldBuilder& build, const Section& from, const Section& to) {
  constexpr double kEdge = kHalfWidth - kKerbWidth;
  add_strip(build, from, to, -kEdge, kEdge, 0, materials::kAsphalt);
  add_strip(build, from, to, -kHalfWidth, -kEdge, kKerbHeight, materials::kConcrete);
  add_strip(build, from, to, kEdge, kHalfWidth, kKerbHeight, materials::kConcrete);
  build.quad(to.at(kEdge, 0), from.at(kEdge, 0), from.at(kEdge, kKerbHeight),
             to.at(kEdge, kKerbHeight), materials::kConcrete);
  build.quad(from.at(-kEdge, 0), to.at(-kEdge, 0), to.at(-kEdge, kKerbHeight),
             from.at(-kEdge, kKerbHeight), materials::kConcrete);
}

void add_tube(WorldBuilder& build) {
  const auto holes = recesses();
  for (double s = 0; s < kLength; s += kStep) {
    add_ground(build, section(s), section(s + kStep));
    add_vault(build, section(s), section(s + kStep));
    add_wall(build, s, false, holes);
    add_wall(build, s, true, holes);
  }
}

/// The wall round a portal, seen from outside. At the far end (`out` = -1) left and right change.
void add_portal_face(WorldBuilder& build, const Section& portal, double out) {
  const auto face = [&](double y, double z) { return portal.at(out * y, z); };
  const auto panel = [&](double y0, double y1, double z0, double z1) {
    build.quad(face(y1, z0), face(y0, z0), face(y0, z1), face(y1, z1), materials::kBrick);
  };
  panel(-kForecourtHalfWidth, -kHalfWidth, 0, kSpring);
  panel(kHalfWidth, kForecourtHalfWidth, 0, kSpring);
  panel(-kForecourtHalfWidth, -kHalfWidth, kSpring, kFaceHeight);
  panel(kHalfWidth, kForecourtHalfWidth, kSpring, kFaceHeight);
  const auto corners = vault();
  for (std::size_t i = 0; i < kFacets; ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[i + 1];
    build.quad(face(b.x(), b.y()), face(a.x(), a.y()), face(a.x(), kFaceHeight),
               face(b.x(), kFaceHeight), materials::kBrick);
  }
}

/// The open cutting before a portal at `s`; `out` is -1 before the tube and +1 behind it.
void add_forecourt(WorldBuilder& build, double s, double out) {
  const Section portal = section(s);
  const Section end = section(s + out * kForecourt);
  const Section& from = out < 0 ? end : portal;
  const Section& to = out < 0 ? portal : end;
  const double y = kForecourtHalfWidth;
  add_strip(build, from, to, -y, y, 0, materials::kAsphalt);
  build.wall({from.at(-y), to.at(-y), 0, 3.0, materials::kConcrete, {}});
  build.wall({to.at(y), from.at(y), 0, 3.0, materials::kConcrete, {}});
  add_portal_face(build, portal, -out);
  const Section middle = section(s + out * 5);
  const Vector3d kiosk = middle.at(6.1, 1.2);
  build.box({kiosk, {1.8, 1.4, 2.4}, middle.heading}, materials::kPlaster);
  add_pole(build, {section(s + out * 4).at(-6.4), middle.heading}, 5);
}

/// Turned so that +x points from the wall to the axis.
Placement on_wall(double s, bool left) {
  const Section at = section(s);
  const double inwards = at.heading + (left ? -0.5 : 0.5) * std::numbers::pi;
  return {at.at(left ? kHalfWidth : -kHalfWidth), inwards};
}

void add_equipment(WorldBuilder& build) {
  const Material& metal = materials::kPaintedMetal;
  const auto cabinet = [&](double s, bool left) {
    add_wall_box(build, on_wall(s, left), kKerbHeight, {0.22, 0.6, 1.1}, metal);
  };
  const auto sign = [&](double s, bool left) {
    add_wall_box(build, on_wall(s, left), 2.3, {0.42, 0.05, 0.42}, metal);
  };
  const auto lamp = [&](double s, double y) {
    const Section at = section(s);
    build.object({"lamp", true}, [&] {
      build.box({at.at(y, 4.45), {1.2, 0.3, 0.15}, at.heading}, metal);
    });
  };
  cabinet(11.2, false);
  cabinet(39.0, true);
  cabinet(179.4, false);
  sign(50.7, false);
  sign(168.1, true);
  lamp(27.0, -2.4);
  lamp(173.0, 2.4);
  const auto standing = [&](double s, double y, const char* name, const Vector3d& size) {
    const Section at = section(s);
    build.object({name}, [&] { build.box({at.at(y, 0.5 * size.z()), size, at.heading}, metal); });
  };
  build.spare([&] {
    standing(24.5, 3.5, "trolley", {1.4, 0.7, 1.1});
    standing(67.0, -3.55, "barrier", {1.5, 0.4, 0.9});
    standing(150.5, 3.5, "trolley", {1.2, 0.7, 1.3});
    standing(186.0, 3.55, "barrier", {1.5, 0.4, 0.9});
    sign(18.0, false);
    lamp(188.0, -2.4);
  });
}

}  // namespace

// A road tunnel: walls, vault and kerbs hold the robot in all directions but one. Doors, niches,
// cabinets, signs and lamps 10 to 25 m apart tell a little about that one: within the tube 20 to
// 200 of 28 000 returns lie on faces across the axis, in the bare stretch 4 to 10. The portals'
// faces look outwards and cannot be seen from within. x points along the first straight, its origin
// lies on the axis in the first portal.
Scenario make_tunnel() {
  WorldBuilder build;
  add_tube(build);
  add_forecourt(build, 0, -1);
  add_forecourt(build, kLength, 1);
  add_equipment(build);

  Scenario scenario;
  scenario.name = "tunnel";
  scenario.world = build.build();
  const auto corner = [](const Vector2d& at, double radius) {
    return RouteCorner{{at.x(), at.y(), 0}, radius};
  };
  const Section begin = section(-kTurning);
  const Section end = section(kLength + kTurning);
  scenario.route = Route::closed(
      {corner(begin.at(-kLane), kLane), corner(lane_corner(-kLane), kCurveRadius + kLane),
       corner(end.at(-kLane), kLane), corner(end.at(kLane), kLane),
       corner(lane_corner(kLane), kCurveRadius - kLane), corner(begin.at(kLane), kLane)});
  scenario.style.distance_m = 440;
  scenario.style.speed_m_s = 8;
  scenario.style.acceleration_m_s2 = 1.5;
  scenario.style.lateral_m_s2 = 2.0;
  scenario.style.body_height_m = 0.9;
  scenario.style.weave_m = 0.3;
  scenario.style.weave_length_m = 40;
  scenario.style.sway_rad = 0.006;
  scenario.style.heave_m = 0.006;
  return scenario;
}

}  // namespace holdfast::simulation
