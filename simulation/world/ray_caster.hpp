#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// Eight rays that are cast together; they should point about the same way. Directions have unit
/// length.
struct alignas(32) RayPacket {
  static constexpr int kSize = 8;
  std::array<float, kSize> x, y, z;     ///< origins, metres
  std::array<float, kSize> dx, dy, dz;  ///< directions
};

/// What each ray of a packet met first.
struct alignas(32) HitPacket {
  std::array<float, RayPacket::kSize> range;             ///< metres; infinite where nothing was met
  std::array<float, RayPacket::kSize> cos_incidence;     ///< 0 (grazing) to 1 (square)
  std::array<std::uint16_t, RayPacket::kSize> material;  ///< index into World::materials
  /// Index into World::triangles; discs count on from the last triangle; 0 where nothing was met.
  std::array<std::uint32_t, RayPacket::kSize> triangle;
};

/// Normal of what a ray met (HitPacket::triangle), unit length: of a triangle on its front.
Eigen::Vector3d normal_of(const World& world, std::size_t surface);

/// Casts rays into a world's triangles and discs. Thread-safe once made; same bits for the same
/// rays.
class RayCaster {
 public:
  explicit RayCaster(const World& world);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// First hits between `min_range` and `max_range` metres.
  void cast(const RayPacket& rays, float min_range, float max_range, HitPacket& hits) const;

  /// Of a triangle or disc of the world (numbered as in HitPacket), on its front, unit length (zero
  /// for one without an area).
  const Eigen::Vector3f& normal(std::uint32_t surface) const { return normals_[surface]; }

  /// True when nothing stands between `from` and `to` (but for the last `slack` metres).
  bool is_visible(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                  float slack = 0.002F) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  std::vector<std::uint16_t> material_of_;  ///< of triangles, then of discs
  std::uint32_t first_disc_;
  std::vector<Eigen::Vector3f> normals_;  ///< likewise
};

}  // namespace holdfast::simulation
