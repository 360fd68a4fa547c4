#pragma once

#include <vector>

#include "holdfast/core/time.hpp"
#include "simulation/motion/route.hpp"
#include "simulation/motion/trajectory.hpp"

/// How a person lifts a body that stands on a route, carries it along the route and puts it down.
namespace holdfast::simulation {

/// From where to where.
struct CarryPath {
  const Route& route;
  double from_s = 0;  ///< on the route
  double way_m = 0;   ///< along the route, negative backwards
  PoseVector from;    ///< beside or on the route at from_s
  PoseVector to;      ///< likewise at from_s + way_m; its yaw within half a turn of from's
};

/// Control poses of the motion at `ticks` + 1 consecutive knots, the first `path.from`, the last
/// `path.to`, at rest at both ends: along the route, lifted by up to half a metre (less where there
/// is little time), with the heave of steps and some tilting.
std::vector<PoseVector> carried(const CarryPath& path, std::size_t ticks, TimeNs knot);

/// True when a person could do it: a spline through these control poses (whose derivatives are
/// means of their differences) stays within 3 m/s, 4 m/s^2 and a yaw rate of 2.5 rad/s.
bool is_humanly_possible(const std::vector<PoseVector>& controls, TimeNs knot);

}  // namespace holdfast::simulation
