#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/places/place.hpp"

namespace holdfast::places {

/// The places of a map: what is usual where. Read-only; queries are thread-safe.
class Places {
 public:
  /// Reads the places of the map in `dir`: none if it was made without. Errors name the file and
  /// what was expected.
  static Result<Places> open(const std::filesystem::path& dir);
  Places(Places&& other) noexcept;
  Places& operator=(Places&& other) noexcept;
  ~Places();

  /// In the order of the file, which is that in which they were chosen.
  const std::vector<Place>& all() const { return places_; }
  /// Position of the LiDAR at a place in the map frame.
  Eigen::Vector3d position(const Place& place) const {
    return origin_ + place.position.cast<double>();
  }

  /// The place nearest to a LiDAR at `p_map`, or nullptr if none is within `reach_m`. A difference
  /// of height counts kHeightWeight times, so that one of the same floor comes first whatever the
  /// height of the LiDAR. About 1 us; allocates nothing.
  const Place* nearest(const Eigen::Vector3d& p_map, double reach_m) const;
  static constexpr float kHeightWeight = 3.0F;

 private:
  struct Index;
  Places(std::vector<Place> places, const Eigen::Vector3d& origin);

  std::vector<Place> places_;
  Eigen::Vector3d origin_;
  std::unique_ptr<Index> index_;
};

}  // namespace holdfast::places
