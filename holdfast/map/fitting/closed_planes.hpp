#pragma once

#include <vector>

#include "holdfast/map/fitting/surface_fit.hpp"
#include "holdfast/map/fitting/surface_grid.hpp"

namespace holdfast::map {

/// Marks the planes that no ray passes near their centre (Surface::closed): those with points in
/// each of eight sectors round it, up to one cell away. What has an edge, a gap or a hole there is
/// left unmarked, and so is what is so sparse that it might have.
void mark_closed_planes(const PointGrid& points, const FitOptions& options,
                        const std::vector<Cell>& fitted, SurfaceGrid& grid,
                        std::vector<Surface>& surfaces);

}  // namespace holdfast::map
