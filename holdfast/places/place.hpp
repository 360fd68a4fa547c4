#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace holdfast::places {

/// What a robot would see at one free position of a map, and how well that would agree with the
/// map, were its pose right. Shares are of the rays that hit something. Lies in memory as it lies
/// on disk; lengths in metres, the position relative to the map's origin.
struct Place {
  Eigen::Vector3f position;  ///< of the LiDAR, at an assumed height above the floor
  float hit_share;           ///< of all rays: those that hit something within reach
  float agreeing_share;      ///< mean robust weight; what StepReport::inlier_share would say
  float through_share;       ///< monitor::SightCounts::through; likewise the next two
  float in_front_share;
  float unmapped_share;
  float weakest_sigma_m;    ///< of the position along `weakest`, from one scan; kUnknownSigmaM
                            ///< at most
  Eigen::Vector3f weakest;  ///< unit vector of the map frame, of arbitrary sign
};
static_assert(sizeof(Place) == 48, "the layout is the format of places.bin");

/// The sigma of a direction about which a scan says nothing.
constexpr float kUnknownSigmaM = 10.0F;
/// Places with a weakest_sigma_m above this are poorly localizable.
constexpr float kPoorSigmaM = 0.05F;

}  // namespace holdfast::places
