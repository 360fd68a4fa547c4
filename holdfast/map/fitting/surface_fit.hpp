#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/map/fitting/point_grid.hpp"
#include "holdfast/map/surface.hpp"

namespace holdfast::map {

/// How surfaces are fitted to the points around a cell. Lengths that have to do with the sensor
/// come from the map itself (noise_m), those that have to do with shape are shares of the cell.
struct FitOptions {
  double noise_m = 0.01;       ///< RMS distance of points to a plane where the world is a plane
  double wide_radius = 2.0;    ///< of the neighbourhood tried first, in cells
  double narrow_radius = 1.0;  ///< of the neighbourhood where the wide one is no plane, in cells
  int min_support = 6;
  bool planes = true;
  bool lines = true;
};

/// Fits the planes (up to three, the best supported first) or else the line that explain the points
/// of `cell`, article 3.2.2 steps (1) and (2), done once when the map is made instead of for each
/// query. The neighbourhood is a ball around the centroid of the cell's points, so that a wall that
/// coincides with the border of two cells is not cut into two biased halves. Appends to `out`.
void fit_cell(const PointGrid& grid, const Cell& cell, const FitOptions& options,
              std::vector<Surface>& out);

/// RMS distance of `support` points to the plane fitted to them, without bias; 0 points where they
/// are too few.
struct Thickness {
  double sigma_m = 0;
  int support = 0;
};

/// Of the wide neighbourhood of `cell`. For the estimate of a map's noise.
Thickness plane_thickness(const PointGrid& grid, const Cell& cell, const FitOptions& options);

}  // namespace holdfast::map
