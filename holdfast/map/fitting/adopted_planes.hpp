#pragma once

#include <vector>

#include "holdfast/map/fitting/surface_fit.hpp"
#include "holdfast/map/fitting/surface_grid.hpp"

namespace holdfast::map {

/// Lists in each cell of `fitted` the planes of its neighbours, too, that reach to its border and
/// that it has no plane for. The noise of a range carries points across borders: those of a door
/// jamb just beyond one would be paired on their own side only, and half of a symmetric noise has a
/// mean (of 0.8 sigma: 16 mm for a LiDAR of 20 mm). Puts the lists of `surfaces` in the order of
/// `fitted`; cells that are empty in `grid` stay so.
void adopt_planes(const PointGrid& points, const FitOptions& options,
                  const std::vector<Cell>& fitted, SurfaceGrid& grid,
                  std::vector<Surface>& surfaces);

}  // namespace holdfast::map
