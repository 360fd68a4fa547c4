#include "simulation/buildings/tunnel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulation/world/furniture.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSpring = 2.8;  // height at which the vault begins
constexpr double kRise = 2.6;    // of the vault above that
constexpr int kFacets = 14;      // of the vault, 13 degrees each
constexpr double kKerbWidth = 0.6;
constexpr double kKerbHeight = 0.2;
constexpr double kStep = 2.5;  // metres of tube made of flat pieces
constexpr double kCuttingHalfWidth = 7;
constexpr double kFaceHeight = 7;  // of the wall that a portal stands in

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

WallOpening opening_of(const TunnelRecess& recess) {
  if (recess.kind == "door") {
    return {0, 1.1, kKerbHeight, 2.3, 0.12, false, materials::kPaintedMetal};
  }
  return {0, 1.3, kKerbHeight, 2.2, 0.35, false, materials::kConcrete};
}

/// The parts of a tunnel.
class Tube {
 public:
  Tube(const Tunnel& plan, WorldBuilder& build) : plan_(plan), build_(build) {}

  void build_all() {
    add_tube();
    add_cutting(0, -1);
    add_cutting(plan_.length, 1);
  }

 private:
  /// Where so far along the axis.
  Section section(double s) const {
    const double curve_end = plan_.curve_begin + plan_.curve_length;
    const double radius = plan_.curve_radius;
    const double bend = std::clamp(s, plan_.curve_begin, curve_end) - plan_.curve_begin;
    const double turn = bend / radius;
    const double rest = std::max(s - curve_end, 0.0);
    const Vector2d arc(radius * std::sin(turn), radius * (1 - std::cos(turn)));
    const Vector2d ahead(std::cos(turn), std::sin(turn));
    return {Vector2d(std::min(s, plan_.curve_begin), 0) + arc + rest * ahead, turn};
  }

  double half_width() const { return 0.5 * plan_.width; }

  /// One side of the tube between two sections, seen from within.
  void add_wall(double s, bool left) {
    const Section from = section(left ? s + kStep : s);
    const Section to = section(left ? s : s + kStep);
    const double y = left ? half_width() : -half_width();
    WallPlan wall{from.at(y), to.at(y), 0, kSpring, materials::kConcrete, {}};
    for (const TunnelRecess& recess : plan_.recesses) {
      if ((recess.side == "left") != left || recess.at < s || recess.at >= s + kStep) continue;
      WallOpening hole = opening_of(recess);
      hole.start = std::min(recess.at - s, kStep - hole.width - 0.1);
      wall.openings.push_back(hole);
    }
    // On the right a wall runs with the axis and is seen from its left; on the left, against it.
    build_.wall(wall);
  }

  /// Height and distance from the axis of the vault's corners, from right to left.
  std::array<Vector2d, kFacets + 1> vault() const {
    std::array<Vector2d, kFacets + 1> corners;
    for (int i = 0; i <= kFacets; ++i) {
      const double angle = std::numbers::pi * i / kFacets;
      corners[static_cast<std::size_t>(i)] = {-half_width() * std::cos(angle),
                                              kSpring + kRise * std::sin(angle)};
    }
    return corners;
  }

  void add_vault(const Section& from, const Section& to) {
    const auto corners = vault();
    for (std::size_t i = 0; i < kFacets; ++i) {
      const Vector2d& a = corners[i];
      const Vector2d& b = corners[i + 1];
      build_.quad(from.at(a.x(), a.y()), to.at(a.x(), a.y()), to.at(b.x(), b.y()),
                  from.at(b.x(), b.y()), materials::kConcrete);
    }
  }

  /// A strip of ground between two sections, from y0 on the right to y1 on the left.
  void add_strip(const Section& from, const Section& to, double y0, double y1, double z,
                 const Material& material) {
    build_.quad(from.at(y0, z), to.at(y0, z), to.at(y1, z), from.at(y1, z), material);
  }

  void add_ground(const Section& from, const Section& to) {
    const double edge = half_width() - kKerbWidth;
    add_strip(from, to, -edge, edge, 0, materials::kAsphalt);
    add_strip(from, to, -half_width(), -edge, kKerbHeight, materials::kConcrete);
    add_strip(from, to, edge, half_width(), kKerbHeight, materials::kConcrete);
    build_.quad(to.at(edge, 0), from.at(edge, 0), from.at(edge, kKerbHeight),
                to.at(edge, kKerbHeight), materials::kConcrete);
    build_.quad(from.at(-edge, 0), to.at(-edge, 0), to.at(-edge, kKerbHeight),
                from.at(-edge, kKerbHeight), materials::kConcrete);
  }

  void add_tube() {
    for (double s = 0; s < plan_.length; s += kStep) {
      add_ground(section(s), section(s + kStep));
      add_vault(section(s), section(s + kStep));
      add_wall(s, false);
      add_wall(s, true);
    }
  }

  /// The wall round a portal, seen from outside. At the far end (`out` = -1) left and right change.
  void add_portal_face(const Section& portal, double out) {
    const auto face = [&](double y, double z) { return portal.at(out * y, z); };
    const auto panel = [&](double y0, double y1, double z0, double z1) {
      build_.quad(face(y1, z0), face(y0, z0), face(y0, z1), face(y1, z1), materials::kBrick);
    };
    panel(-kCuttingHalfWidth, -half_width(), 0, kSpring);
    panel(half_width(), kCuttingHalfWidth, 0, kSpring);
    panel(-kCuttingHalfWidth, -half_width(), kSpring, kFaceHeight);
    panel(half_width(), kCuttingHalfWidth, kSpring, kFaceHeight);
    const auto corners = vault();
    for (std::size_t i = 0; i < kFacets; ++i) {
      const Vector2d& a = corners[i];
      const Vector2d& b = corners[i + 1];
      build_.quad(face(b.x(), b.y()), face(a.x(), a.y()), face(a.x(), kFaceHeight),
                  face(b.x(), kFaceHeight), materials::kBrick);
    }
  }

  /// The open cutting before a portal at `s`; `out` is -1 before the tube and +1 behind it.
  void add_cutting(double s, double out) {
    const Section portal = section(s);
    const Section end = section(s + out * plan_.cutting);
    const Section& from = out < 0 ? end : portal;
    const Section& to = out < 0 ? portal : end;
    const double y = kCuttingHalfWidth;
    add_strip(from, to, -y, y, 0, materials::kAsphalt);
    build_.wall({from.at(-y), to.at(-y), 0, 3.0, materials::kConcrete, {}});
    build_.wall({to.at(y), from.at(y), 0, 3.0, materials::kConcrete, {}});
    add_portal_face(portal, -out);
    const Section middle = section(s + out * 5);
    const Vector3d kiosk = middle.at(6.1, 1.2);
    build_.box({kiosk, {1.8, 1.4, 2.4}, middle.heading}, materials::kPlaster);
    add_pole(build_, {section(s + out * 4).at(-6.4), middle.heading}, 5);
  }

  const Tunnel& plan_;
  WorldBuilder& build_;
};

}  // namespace

void Tunnel::add_to(WorldBuilder& build) const { Tube(*this, build).build_all(); }

}  // namespace holdfast::simulation
