#pragma once

#include "holdfast/filter/filter_state.hpp"

namespace holdfast::odometry {

/// Along a direction that scans hardly determine, the local map drifts with the robot: what is seen
/// of it there was put into it a moment ago, with the robot's error of that moment. If the position
/// counted from where the map began, it would be ever less certain, and the next thing that comes
/// into sight would seem to tell the whole way, and with it the velocity, though it tells no more
/// than the way since it was first seen.
///
/// So wherever the position's error has grown beyond what the map holds, it is counted anew from
/// where the robot is. Returns what the errors were multiplied by, for all that has a covariance
/// with them. Call after a scan that was matched; without scans the map does not drift.
filter::Matrix15d count_from_here(filter::FilterState& state);

}  // namespace holdfast::odometry
