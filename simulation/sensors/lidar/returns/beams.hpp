#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "simulation/sensors/lidar/return_kind.hpp"
#include "simulation/world/material.hpp"

namespace holdfast::simulation {

/// What a beam brings back, without noise.
struct Echo {
  float range = std::numeric_limits<float>::infinity();  ///< metres; infinite: nothing
  float cos_incidence = 0;
  float power = 1;             ///< share of the beam's light that met it
  std::uint16_t material = 0;  ///< index into World::materials; beyond them: somebody or something
                               ///< that moves
  ReturnKind kind = ReturnKind::kSurface;

  bool is_there() const { return range < std::numeric_limits<float>::infinity(); }
};

/// The beams of consecutive columns, [column][beam], in the map frame, and what they met.
struct Beams {
  std::size_t per_column = 0;
  std::vector<Eigen::Vector3f> origin;
  std::vector<Eigen::Vector3f> direction;
  std::vector<std::uint32_t> triangle;  ///< that the axis met, unless something that moves did
  std::vector<Echo> echoes;
  std::vector<Echo> before;  ///< of the column before the first; none: that is the frame's first
  std::vector<Echo> after;   ///< likewise

  std::size_t columns() const { return echoes.size() / per_column; }
};

/// The materials of a world, and that of whatever moves in it.
class Materials {
 public:
  explicit Materials(const std::vector<Material>& of_world) : of_world_(of_world) {}
  bool moves(std::uint16_t index) const { return index >= of_world_.size(); }
  const Material& operator[](std::uint16_t index) const {
    return moves(index) ? materials::kClothing : of_world_[index];
  }

 private:
  const std::vector<Material>& of_world_;
};

}  // namespace holdfast::simulation
