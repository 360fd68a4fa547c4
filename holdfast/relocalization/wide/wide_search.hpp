#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "holdfast/relocalization/occupancy/standpoints.hpp"
#include "holdfast/relocalization/wide/lane_counter.hpp"
#include "holdfast/relocalization/wide/turned_points.hpp"

namespace holdfast::relocalization {

struct WideOptions {
  double keep_share = 0.8;        ///< of the best score: modes down to it are kept...
  double least_keep_share = 0.9;  ///< ...or, where these are too many, down to this
  double least_share = 0.4;       ///< of the points; what hits less is no mode
  double apart_m = 1.0;           ///< modes that are nearer than that...
  double apart_rad = 0.1745;      ///< ...and turned by less are one
  std::size_t most_modes = 400;
  std::uint64_t most_work = 1'000'000'000;
};

/// A cell and a yaw from which more points hit something than from all others near.
struct Mode {
  Cell cell;
  int yaw = 0;
  int hits = 0;
};

struct WideResult {
  std::vector<Mode> modes;   ///< the best first
  int points = 0;            ///< that were searched with
  std::uint64_t work = 0;    ///< points looked up
  bool out_of_work = false;  ///< there may be better ones
  bool too_alike = false;    ///< so many that nothing tells them apart: not all were kept
};

/// Branch and bound over x, y, z and yaw: exact for the number of points that hit an occupied cell.
/// All heights of a point are one look-up (design, section 4). Blocks of 4 m are bounded first, the
/// most promising opened first, and what cannot reach the kept share of the best is left out. Same
/// input, same modes.
class WideSearch {
 public:
  WideSearch(const OccupancyPyramid& map, const Standpoints& standpoints,
             const TurnedPoints& points, const WideOptions& options);

  /// `points` of them are real.
  WideResult run(std::size_t points);

 private:
  /// A block of cells at a yaw, and the heights at which it may still hold a mode.
  struct Node {
    int bound = 0;
    int x = 0, y = 0;
    std::int16_t yaw = 0, word = 0;
    std::uint64_t lanes = 0;
  };

  int least_hits() const;
  bool bound(int level, Node& node);
  template <bool kStrided, bool kOneWord>
  bool count(int level, const Node& node, LaneCounter& counter);
  void open_roots(std::vector<Node>& roots);
  void descend(int level, const Node& node);
  void keep(const Node& node);
  void make_room();
  void thin_out();

  const OccupancyPyramid& map_;
  const Standpoints& standpoints_;
  const TurnedPoints& points_;
  WideOptions options_;
  int real_points_ = 0;
  int best_ = 0;
  std::uint64_t work_ = 0;
  std::vector<Mode> kept_;
  bool too_alike_ = false;
};

}  // namespace holdfast::relocalization
