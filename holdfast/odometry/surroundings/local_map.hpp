#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "holdfast/odometry/surroundings/cell_table.hpp"
#include "holdfast/odometry/surroundings/local_map_config.hpp"
#include "holdfast/registration/correspondences.hpp"

namespace holdfast::odometry {

/// The surroundings of the last tens of metres as planes in cubic cells, made from the odometry's
/// own scans. Each cell keeps running moments of its points; its plane is fitted anew when they
/// have grown by a share. Memory is fixed: cells out of reach are forgotten, at need nearer ones.
///
/// Cells come in three sizes. A large plane is known far better than a small one, above all its
/// tilt: tilts that follow the noise hold the robot where it saw them. So the largest cell that is
/// one plane answers, and the small ones serve where surfaces meet. A cell is no plane while its
/// points are too few or on less than three lines (two lines lie on a plane whatever they were
/// drawn on), and where they are thicker than the noise of ranges explains.
///
/// A SurfaceMap; LocalPairing pairs scans with it.
class LocalMap {
 public:
  static constexpr std::size_t kSizes = 3;  ///< of cells, each twice the one before

  /// `range_sigma_m`: noise of the LiDAR along the ray.
  LocalMap(const LocalMapConfig& config, double range_sigma_m);

  struct Hit {
    const map::Surface* surface = nullptr;
    Eigen::Vector3f corner = Eigen::Vector3f::Zero();  ///< centre of the cell, from the anchor
    bool firm = false;  ///< the plane has stood the test of points that it does not follow from
  };
  /// Level 0: the plane of the largest cell around `p` (relative to the anchor, metres) that is
  /// one. Level 1: that of the largest cells alone, however far off its plane `p` may be.
  Hit find(int level, const Eigen::Vector3f& p) const {
    const std::size_t last = level == 0 ? 0 : kSizes - 1;
    for (std::size_t i = kSizes; i-- > last;) {
      const Layer& layer = layers_[i];
      const Eigen::Vector3i cell = layer.cell_of(p);
      const CellTable::Entry& entry = layer.table.look_up(cell_key(cell + layer.anchor_cell));
      if ((entry.flags & kPlane) == 0) continue;
      return {&layer.surfaces[entry.index], (cell.cast<float>().array() + 0.5F) * layer.cell_m,
              (entry.flags & kFirm) != 0};
    }
    return {};
  }

  /// Has the memory fetched that find(level, p) will need first.
  void prefetch(int level, const Eigen::Vector3f& p) const {
    const std::size_t last = level == 0 ? kSizes - 2 : kSizes - 1;
    for (std::size_t i = kSizes; i-- > last;) layers_[i].table.prefetch(layers_[i].key_of(p));
  }

  /// A place near the robot in the odometry's frame; positions count from it in float.
  const Eigen::Vector3d& anchor() const { return anchor_; }

  /// Adds points of a scan: deskewed, in the body frame at `T_odom_body`; `p_body_lidar` is where
  /// they were seen from. Far points count less: an error of the rotation moves them more.
  /// Of more than `most` points every so many are taken, others with another `number`.
  void insert(const std::vector<Eigen::Vector3f>& points, const SE3& T_odom_body,
              const Eigen::Vector3d& p_body_lidar, std::size_t most = SIZE_MAX,
              std::uint64_t number = 0);

  /// Moves the anchor to the robot and forgets some of the cells that are out of reach; call once a
  /// scan.
  void follow(const Eigen::Vector3d& p_odom);

  void clear();

  /// Number of lines (beams, from places apart) that a plane needs from now on: two lie on a plane
  /// whatever they were drawn on, which matters while nothing else tells the motion.
  void set_least_lines(int lines) { least_lines_ = lines; }

  /// Cells in use of the size `i`.
  std::size_t cells(std::size_t i) const { return layers_[i].used(); }
  /// Points that found no room; 0 unless the surroundings are far larger than the map was made for.
  std::uint64_t refused() const { return refused_; }
  std::size_t memory_bytes() const;

 private:
  /// What is known of a cell without looking at it.
  enum Flag : std::uint32_t { kPlane = 1, kFirm = 2, kFull = 4 };
  static constexpr std::uint64_t kNoCell = UINT64_MAX;

  /// Points of one cell, relative to its centre: a line of the cache.
  struct alignas(64) Cell {
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    float weight = 0;
    std::array<float, 6> scatter{};  ///< sums of products about the mean: xx, xy, xz, yy, yz, zz
    Eigen::Vector3f seen_from = Eigen::Vector3f::Zero();  ///< mean place of the LiDAR
    std::uint32_t lines = 0;  ///< bits of the lines that its points lie on
    float refit_at = 0;       ///< weight from which on the plane is fitted anew
    std::uint32_t flags = 0;  ///< as in the table
  };
  static_assert(sizeof(Cell) == 64);
  struct Layer {
    float cell_m = 0, cells_per_m = 0;
    Eigen::Vector3i anchor_cell = Eigen::Vector3i::Zero();
    CellTable table;
    std::vector<Cell> cells;
    std::vector<map::Surface> surfaces;  ///< of the cells with the same index
    std::vector<std::uint64_t> keys;     ///< likewise; kNoCell where a cell is free
    std::vector<std::uint32_t> free;     ///< indices into cells
    std::size_t swept = 0;               ///< where forgetting goes on
    double radius_m = 0;                 ///< smaller than configured while room is short

    Eigen::Vector3i cell_of(const Eigen::Vector3f& p) const {
      return (p * cells_per_m).array().floor().cast<int>();
    }
    std::uint64_t key_of(const Eigen::Vector3f& p) const {
      return cell_key(cell_of(p) + anchor_cell);
    }
    std::size_t used() const { return cells.size() - free.size(); }
  };

  /// A point and the LiDAR that saw it, relative to the anchor or to a cell's centre.
  struct Sighting {
    Eigen::Vector3f p, lidar;
    float weight;
    std::uint32_t line;  ///< a bit of the beam and of the place that it was seen from
  };
  void add(const std::vector<Sighting>& seen);
  void add(Layer& layer, const Sighting& seen);
  bool add_to(Cell& cell, const Sighting& seen) const;
  std::uint32_t fit(const Layer& layer, Cell& cell, map::Surface& surface) const;
  void forget_far(Layer& layer, const Eigen::Vector3d& p_odom);
  void set_anchor(const Eigen::Vector3d& p_odom);

  LocalMapConfig config_;
  float range_variance_;
  std::array<Layer, kSizes> layers_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d stood_ = Eigen::Vector3d::Constant(1e9);  ///< LiDAR when places were last counted
  std::uint32_t place_ = 0;
  int least_lines_ = 2;
  std::uint64_t refused_ = 0;
  std::vector<Sighting> block_;  ///< points on their way into the map
};

static_assert(registration::SurfaceMap<LocalMap>);

}  // namespace holdfast::odometry
