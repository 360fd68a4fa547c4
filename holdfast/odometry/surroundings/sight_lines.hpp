#pragma once

#include "holdfast/odometry/surroundings/local_map.hpp"

namespace holdfast::odometry {

/// Share of a scan's points that were seen through a plane of the local map: points without a pair
/// whose ray crosses one well before it ends. People and things that came stand in front of walls;
/// a robot that was carried away looks through them. `points` in the body frame, `pairs` as
/// associated at `T_odom_body`; about `most` points are looked at.
double share_seen_through(const LocalMap& map, const registration::BodyPoints& points,
                          const registration::Correspondences& pairs, const SE3& T_odom_body,
                          const Eigen::Vector3d& p_body_lidar, std::size_t most);

}  // namespace holdfast::odometry
