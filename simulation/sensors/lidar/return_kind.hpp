#pragma once

#include <cstdint>

namespace holdfast::simulation {

/// Where a return comes from.
enum class ReturnKind : std::uint8_t {
  kSurface,    ///< the surface on the axis of its beam
  kMixed,      ///< two surfaces side by side in the beam: a range in between, or the other one's
  kGhost,      ///< a surface that the beam met by way of a mirror
  kMultipath,  ///< two faces of a corner: too long
  kAir,        ///< rain or dust
};

}  // namespace holdfast::simulation
