#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace holdfast::map {

/// Clutter: points that neither planes nor a line explain; nothing can be matched there, and a
/// coarser resolution would only hide it.
enum class SurfaceKind : std::uint8_t { kPlane = 0, kLine = 1, kClutter = 2 };

/// A plane or a line fitted to the points of the prior map around one cell. Lies in memory as it
/// lies on disk. Lengths in metres, positions relative to the low corner of the tile (z: of the
/// map's origin).
struct Surface {
  Eigen::Vector3f center;  ///< a point of the plane or line, inside the cell it was made for
  Eigen::Vector3f normal;  ///< plane: unit normal of arbitrary sign; line: unit direction
  float sigma_m;           ///< RMS distance of the supporting points to the plane or line
  std::uint16_t support;   ///< supporting points on a disc of one cell's radius, saturated
  SurfaceKind kind;
  std::uint8_t more : 1;        ///< 1: the next Surface belongs to the same cell
  std::uint8_t closed : 1 = 0;  ///< 1: a plane that no ray passes near its centre
  std::uint8_t unused : 6 = 0;  ///< named, so that all bits of a tile are set: same map, same bits
};
static_assert(sizeof(Surface) == 32, "the layout is the format of a tile");

}  // namespace holdfast::map
