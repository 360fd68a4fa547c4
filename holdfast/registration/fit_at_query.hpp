#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/result.hpp"
#include "holdfast/core/se3.hpp"

namespace holdfast::registration {

/// The article's matching (3.2.2), with its numbers.
struct FitAtQueryConfig {
  double edge_radius_m = 2.0;
  double plane_radius_m = 1.5;
  int line_points = 3;
  int plane_points = 4;
  int edge_neighbours = 24;
  int plane_neighbours = 8;
  double edge_weight = 1.0;
  double plane_weight = 0.8;
  int least_edges = 10;
  int least_planes = 20;
  int max_searches = 10;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("edge_radius_m", self.edge_radius_m,
          FieldDoc{"r_E: map edges this near to an edge point are its neighbours", 0.05, 20.0});
    visit("plane_radius_m", self.plane_radius_m,
          FieldDoc{"r_F: map planes this near to a planar point are its neighbours", 0.05, 20.0});
    visit("line_points", self.line_points, FieldDoc{"least number of points of a line", 2, 100});
    visit("plane_points", self.plane_points, FieldDoc{"least number of points of a plane", 3, 100});
    visit("edge_neighbours", self.edge_neighbours,
          FieldDoc{"at most this many nearest neighbours are searched for lines", 3, 64});
    visit("plane_neighbours", self.plane_neighbours,
          FieldDoc{"a plane is fitted to at most this many nearest neighbours", 3, 64});
    visit("edge_weight", self.edge_weight, FieldDoc{"w_E, of squared distances", 0.0, 100.0});
    visit("plane_weight", self.plane_weight, FieldDoc{"w_F, of squared distances", 0.0, 100.0});
    visit("least_edges", self.least_edges, FieldDoc{"N_E: fewer matches are invalid", 0, 100000});
    visit("least_planes", self.least_planes, FieldDoc{"N_F: fewer matches are invalid", 0, 100000});
    visit("max_searches", self.max_searches,
          FieldDoc{"times that neighbours are searched anew from the pose found", 1, 100});
  }
};

/// Edge and planar points: of a map in the map frame, of a scan in the body frame.
struct FeatureClouds {
  std::vector<Eigen::Vector3f> edges;
  std::vector<Eigen::Vector3f> planes;
};

/// Splits the points of a prior map by the surfaces fitted when it was made: on a line, or near to
/// two planes of its cell at once: an edge; near to one plane: planar; others are neither.
/// Positions relative to the map's origin (MapInfo::origin). Errors are those of the map's files.
Result<FeatureClouds> classify_points(const std::filesystem::path& map_dir);

struct FitAtQueryResult {
  SE3 T_map_body;
  bool valid = false;  ///< enough matches of both kinds
  int edges = 0;       ///< matches at the end
  int planes = 0;
  double mean_abs_edge_m = 0;   ///< mean distance of matched edge points to their lines
  double mean_abs_plane_m = 0;  ///< mean absolute distance of planar points: signed ones cancel
  int searches = 0;
  bool converged = false;
};

/// Registration with fits at query time, as printed: for each edge point the map's edge points
/// within r_E are split into up to two boundary lines and the nearer one is its line; for each
/// planar point a plane is fitted to the neighbours within r_F; Levenberg-Marquardt on the weighted
/// squared distances. The print does not bound the number of neighbours (some thousands in a dense
/// map) nor ask whether they lie on a plane at all: both limits are LIO-SAM's, which it follows.
/// Slow by design: kept for the article's own figures and as a yardstick.
class FitAtQuery {
 public:
  /// Builds two k-d trees over the clouds.
  explicit FitAtQuery(FeatureClouds map, const FitAtQueryConfig& config = {});
  ~FitAtQuery();
  FitAtQuery(FitAtQuery&&) noexcept;
  FitAtQuery& operator=(FitAtQuery&&) noexcept;

  /// `scan` in the body frame, `T_map_body` in the frame of the map's clouds. Where a match is not
  /// valid the pose is that of the start. Thread-safe.
  FitAtQueryResult align(const FeatureClouds& scan, const SE3& T_map_body) const;

 private:
  struct Trees;

  FitAtQueryConfig config_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace holdfast::registration
