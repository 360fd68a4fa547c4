#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <numbers>

#include "holdfast/core/result.hpp"
#include "holdfast/registration/correspondences.hpp"
#include "holdfast/relocalization/search_config.hpp"
#include "holdfast/relocalization/search_report.hpp"

namespace holdfast::relocalization {

/// Of the direction of gravity in a query, each axis: what find() takes for granted.
constexpr double kGravitySigmaRad = std::numbers::pi / 180.0;

/// What a robot sees that does not know where it is.
struct SearchQuery {
  /// Deskewed returns of one or more scans, all of them in the body frame at the query's time, with
  /// ages against that time. Only rays of the newest 0.15 s are followed through the map. All
  /// returns or a part of them; a few thousand are enough.
  registration::BodyPoints points;
  /// Unit vector, downwards, to within kGravitySigmaRad.
  Eigen::Vector3d gravity_body = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d p_body_lidar = Eigen::Vector3d::Zero();
  double range_sigma_m = 0.02;
};

/// Finds the pose of a robot anywhere in a map (article 3.4.2, where it is a bag of words and
/// RANSAC; ours is design section 4): branch and bound over x, y, z and yaw in the occupied cells
/// of the map, near its places; the best modes refined in six degrees of freedom against its
/// planes; and an answer only if one pose is right in itself and no other is nearly as likely.
///
/// Not thread-safe, and owns its map: one object for each thread that searches. Same query, same
/// answer, with the same bits.
class GlobalSearch {
 public:
  /// Reads the whole map in `dir` (about 1 s for 10 million points). Errors name file and reason;
  /// a map without places is one, since nothing tells where a robot could stand.
  static Result<GlobalSearch> create(const std::filesystem::path& dir, const SearchConfig& config);
  GlobalSearch(GlobalSearch&& other) noexcept;
  GlobalSearch& operator=(GlobalSearch&& other) noexcept;
  ~GlobalSearch();

  /// Takes up to some tenths of a second (SearchConfig::most_work).
  SearchReport find(const SearchQuery& query);

 private:
  struct Parts;
  explicit GlobalSearch(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace holdfast::relocalization
