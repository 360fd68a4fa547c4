#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <utility>
#include <vector>

#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// A box that stands or floats, turned about the vertical.
struct Box {
  Eigen::Vector3d center;
  Eigen::Vector3d size;
  double yaw = 0;
};

/// A hole in a wall: a door recess, a niche, a window, a passage. `start` and `width` count along
/// the wall, `bottom` and `top` are heights in the map.
struct WallOpening {
  double start = 0;
  double width = 1;
  double bottom = 0;
  double top = 2;
  double depth = 0.1;    ///< how far the sides reach behind the face of the wall
  bool through = false;  ///< true: no back, one looks (and may drive) through
  Material back = materials::kWood;
};

/// An upright wall seen from its left (going from `from` to `to`).
struct WallPlan {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  double bottom = 0;
  double top = 3;
  Material material = materials::kPlaster;
  std::vector<WallOpening> openings;  ///< must not overlap along the wall
};

/// Puts a world together from simple solids. Everything is in the map frame, metres, z up. A
/// material is known by its name.
class WorldBuilder {
 public:
  WorldBuilder() = default;
  /// Goes on with a world.
  explicit WorldBuilder(World world) : world_(std::move(world)) {}

  /// Four corners of a flat quadrilateral, counter-clockwise seen from its front.
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
            const Eigen::Vector3d& d, const Material& material);
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                const Material& material);
  /// A disc; its material index is set here.
  void disc(const Disc& disc, const Material& material);
  /// Floor or ground over a rectangle, seen from above.
  void floor(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z,
             const Material& material);
  /// Ceiling over a rectangle, seen from below.
  void ceiling(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double z,
               const Material& material);
  /// A solid box, seen from outside.
  void box(const Box& box, const Material& material);
  /// A solid upright cylinder with facets (error of the surface: radius * (1 - cos(pi /
  /// segments))).
  void cylinder(const Eigen::Vector3d& base, double radius, double height, const Material& material,
                int segments = 48);
  /// A solid upright cone or frustum.
  void cone(const Eigen::Vector3d& base, double radius, double top_radius, double height,
            const Material& material, int segments = 24);
  /// A solid ellipsoid.
  void ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half_axes,
                 const Material& material, int segments = 16);
  /// The face of a wall with the sides and backs of its openings.
  void wall(const WallPlan& plan);

  /// What `parts` builds is one object; objects within it belong to it.
  void object(WorldObject object, const std::function<void()>& parts);
  /// What `parts` builds stands `offset` away from where it says.
  void moved(const Eigen::Vector3d& offset, const std::function<void()>& parts);
  /// The objects in `parts` are spare ones.
  void spare(const std::function<void()>& parts);

  World build() { return std::move(world_); }

 private:
  std::uint16_t material_index(const Material& material);
  void mantle(const Eigen::Vector3d& base, double radius, double top_radius, double height,
              const Material& material, int segments);
  void cap(const Eigen::Vector3d& center, double radius, bool up, const Material& material,
           int segments);
  void opening(const WallPlan& plan, const WallOpening& hole);

  World world_;
  std::uint16_t object_ = 0;  ///< that triangles are being built for, as in World::object_of
  bool spare_ = false;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
};

}  // namespace holdfast::simulation
