#include "simulation/world/world_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string_view>

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d at_height(const Vector2d& p, double z) { return {p.x(), p.y(), z}; }

/// Point on a circle about the vertical through `center`, share `u` of the way round.
Vector3d on_circle(const Vector3d& center, double radius, double u) {
  const double angle = 2 * std::numbers::pi * u;
  return center + Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
}

}  // namespace

std::uint16_t WorldBuilder::material_index(const Material& material) {
  auto& all = world_.materials;
  const auto same = [&](const Material& m) {
    return std::string_view(m.name) == std::string_view(material.name);
  };
  const auto found = std::find_if(all.begin(), all.end(), same);
  if (found != all.end()) return static_cast<std::uint16_t>(found - all.begin());
  all.push_back(material);
  return static_cast<std::uint16_t>(all.size() - 1);
}

void WorldBuilder::triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                            const Material& material) {
  const auto first = static_cast<std::uint32_t>(world_.vertices.size());
  for (const Vector3d& p : {a, b, c}) {
    world_.vertices.push_back((p + offset_).cast<float>());
  }
  world_.triangles.push_back({first, first + 1, first + 2});
  world_.material_of.push_back(material_index(material));
  world_.object_of.push_back(object_);
}

void WorldBuilder::disc(const Disc& disc, const Material& material) {
  world_.discs.push_back(disc);
  world_.discs.back().center = (disc.center.cast<double>() + offset_).cast<float>();
  world_.discs.back().material = material_index(material);
}

void WorldBuilder::object(WorldObject object, const std::function<void()>& parts) {
  const bool outermost = object_ == 0;
  if (outermost) {
    object.spare = object.spare || spare_;
    world_.objects.push_back(std::move(object));
    object_ = static_cast<std::uint16_t>(world_.objects.size());
  }
  parts();
  if (outermost) object_ = 0;
}

void WorldBuilder::moved(const Vector3d& offset, const std::function<void()>& parts) {
  const Vector3d before = offset_;
  offset_ += offset;
  parts();
  offset_ = before;
}

void WorldBuilder::spare(const std::function<void()>& parts) {
  spare_ = true;
  parts();
  spare_ = false;
}

void WorldBuilder::quad(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
                        const Material& material) {
  triangle(a, b, c, material);
  triangle(a, c, d, material);
}

void WorldBuilder::floor(const Vector2d& min, const Vector2d& max, double z,
                         const Material& material) {
  quad({min.x(), min.y(), z}, {max.x(), min.y(), z}, {max.x(), max.y(), z}, {min.x(), max.y(), z},
       material);
}

void WorldBuilder::ceiling(const Vector2d& min, const Vector2d& max, double z,
                           const Material& material) {
  quad({min.x(), max.y(), z}, {max.x(), max.y(), z}, {max.x(), min.y(), z}, {min.x(), min.y(), z},
       material);
}

void WorldBuilder::box(const Box& box, const Material& material) {
  const Eigen::Matrix3d R(Eigen::AngleAxisd(box.yaw, Vector3d::UnitZ()));
  const auto corner = [&](int x, int y, int z) -> Vector3d {
    return box.center + R * (0.5 * box.size.cwiseProduct(Vector3d(x, y, z)));
  };
  quad(corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1), material);
  quad(corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1), material);
  quad(corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1), material);
  quad(corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1), material);
  quad(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1), material);
  quad(corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1), corner(-1, -1, -1), material);
}

void WorldBuilder::mantle(const Vector3d& base, double radius, double top_radius, double height,
                          const Material& material, int segments) {
  const Vector3d top = base + Vector3d(0, 0, height);
  for (int i = 0; i < segments; ++i) {
    const double u0 = static_cast<double>(i) / segments;
    const double u1 = static_cast<double>(i + 1) / segments;
    quad(on_circle(base, radius, u0), on_circle(base, radius, u1), on_circle(top, top_radius, u1),
         on_circle(top, top_radius, u0), material);
  }
}

void WorldBuilder::cap(const Vector3d& center, double radius, bool up, const Material& material,
                       int segments) {
  for (int i = 0; i < segments; ++i) {
    const Vector3d p = on_circle(center, radius, static_cast<double>(i) / segments);
    const Vector3d q = on_circle(center, radius, static_cast<double>(i + 1) / segments);
    up ? triangle(center, p, q, material) : triangle(center, q, p, material);
  }
}

void WorldBuilder::cylinder(const Vector3d& base, double radius, double height,
                            const Material& material, int segments) {
  cone(base, radius, radius, height, material, segments);
}

void WorldBuilder::cone(const Vector3d& base, double radius, double top_radius, double height,
                        const Material& material, int segments) {
  mantle(base, radius, top_radius, height, material, segments);
  cap(base, radius, false, material, segments);
  if (top_radius > 0) cap(base + Vector3d(0, 0, height), top_radius, true, material, segments);
}

void WorldBuilder::ellipsoid(const Vector3d& center, const Vector3d& half_axes,
                             const Material& material, int segments) {
  const int bands = segments / 2;
  const auto point = [&](int band, int i) -> Vector3d {
    const double polar = std::numbers::pi * band / bands;
    const Vector3d unit = on_circle(Vector3d(0, 0, -std::cos(polar)), std::sin(polar),
                                    static_cast<double>(i) / segments);
    return center + half_axes.cwiseProduct(unit);
  };
  for (int band = 0; band < bands; ++band) {
    for (int i = 0; i < segments; ++i) {
      if (band > 0) {
        triangle(point(band, i), point(band, i + 1), point(band + 1, i + 1), material);
      }
      if (band + 1 < bands) {
        triangle(point(band, i), point(band + 1, i + 1), point(band + 1, i), material);
      }
    }
  }
}

void WorldBuilder::opening(const WallPlan& plan, const WallOpening& hole) {
  const Vector2d along = (plan.to - plan.from).normalized();
  const Vector2d behind = Vector2d(along.y(), -along.x()) * hole.depth;
  const Vector2d a = plan.from + along * hole.start;
  const Vector2d b = a + along * hole.width;
  const auto face = [&](const Vector2d& p, double z) { return at_height(p, z); };
  const auto back = [&](const Vector2d& p, double z) { return at_height(p + behind, z); };
  const double low = hole.bottom;
  const double high = hole.top;
  quad(back(a, low), face(a, low), face(a, high), back(a, high), plan.material);
  quad(face(b, low), back(b, low), back(b, high), face(b, high), plan.material);
  quad(face(a, high), face(b, high), back(b, high), back(a, high), plan.material);
  if (low > plan.bottom) {
    quad(back(a, low), back(b, low), face(b, low), face(a, low), plan.material);
  }
  if (!hole.through) {
    quad(back(b, low), back(a, low), back(a, high), back(b, high), hole.back);
  }
}

void WorldBuilder::wall(const WallPlan& plan) {
  const double length = (plan.to - plan.from).norm();
  const Vector2d along = (plan.to - plan.from) / length;
  const auto panel = [&](double u0, double u1, double z0, double z1) {
    if (u1 <= u0 || z1 <= z0) return;
    const Vector2d a = plan.from + along * u0;
    const Vector2d b = plan.from + along * u1;
    quad(at_height(b, z0), at_height(a, z0), at_height(a, z1), at_height(b, z1), plan.material);
  };
  auto openings = plan.openings;
  std::sort(openings.begin(), openings.end(),
            [](const WallOpening& a, const WallOpening& b) { return a.start < b.start; });
  double done = 0;
  for (const WallOpening& hole : openings) {
    assert(hole.start >= done && hole.start + hole.width <= length);
    panel(done, hole.start, plan.bottom, plan.top);
    panel(hole.start, hole.start + hole.width, plan.bottom, hole.bottom);
    panel(hole.start, hole.start + hole.width, hole.top, plan.top);
    opening(plan, hole);
    done = hole.start + hole.width;
  }
  panel(done, length, plan.bottom, plan.top);
}

}  // namespace holdfast::simulation
