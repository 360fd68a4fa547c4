#pragma once

#include <vector>

#include "simulation/truth/segment_grid.hpp"
#include "simulation/world/world.hpp"

namespace holdfast::simulation {

/// Two faces that meet at a smaller angle than this (rad) go on in each other: no edge.
inline constexpr double kSmoothAngle = 20.0 / 180.0 * 3.14159265358979323846;

/// The edges of a world: lines where two faces meet at more than kSmoothAngle, convex or concave,
/// and rims where a face ends. Triangles need not share vertices: what counts is where their sides
/// run along each other (within half a millimetre), so that the side of a wall's panel is an edge
/// only where no other panel goes on. Where faces cut through each other away from their sides, and
/// at the silhouettes of round things, there is no edge. Each edge is listed once; a long one may
/// come in several segments.
std::vector<Segment> true_edges(const World& world);

}  // namespace holdfast::simulation
