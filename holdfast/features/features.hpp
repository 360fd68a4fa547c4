#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/features/feature_config.hpp"

namespace holdfast::features {

/// A point of a scan that lies on an edge or on a plane.
struct Feature {
  std::uint32_t index = 0;                             ///< of the point in the input
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< lidar frame; fitted: on the fitted line
  /// Plane: unit normal towards the sensor. Edge: unit direction. Zero where it is not known
  /// (printed, log; an edge that one ring alone has seen).
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  float sigma_m = 0;  ///< fitted: standard deviation of the position along the normal, across the
                      ///< edge; 0: not known
};

/// Row by row from the lowest, along each row. The lists keep their memory from scan to scan.
struct Features {
  std::vector<Feature> edges;
  std::vector<Feature> planes;
};

/// Finds edge and planar points in a scan (article 3.2.1).
///
/// `printed` is the article: s_i = 1/5 sum |p_i - p_(i+j)|^2 over the two neighbours on each side
/// along the ring, edges above mu + 1.5 sigma, planes below mu - 1.0 sigma. It yields no plane: s
/// is heavy-tailed and mu - sigma negative. `log` takes the logarithm of s, which yields the
/// article's counts but measures the spacing of points, not their shape.
///
/// `fitted` tests a window of a metric length against a straight line, whitened by the range noise
/// at that range and incidence. A plane is straight along its ring and continues straight over two
/// neighbouring rings; an edge is where two straight sides meet at an angle, or where a straight
/// face ends in front of something farther. Windows end at occlusions, missing returns and the rim
/// of the field, and nothing is concluded from what lies behind. O(n); no allocation per point;
/// single thread, not thread-safe.
class FeatureExtractor {
 public:
  /// `range_sigma_m` as in lidar.range_sigma_m.
  FeatureExtractor(const FeatureConfig& config, double range_sigma_m);
  ~FeatureExtractor();
  FeatureExtractor(FeatureExtractor&&) noexcept;
  FeatureExtractor& operator=(FeatureExtractor&&) noexcept;

  /// Raw points: within a window the motion of the sensor is negligible.
  void extract(const Scan& scan, Features& out);

  /// Points relative to the sensor, e.g. a deskewed selection; `rings` as long as `points`, or
  /// empty for a sensor without them.
  void extract(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint16_t>& rings,
               Features& out);

 private:
  struct Work;
  void classify(Features& out);

  FeatureConfig config_;
  std::unique_ptr<Work> work_;
};

}  // namespace holdfast::features
