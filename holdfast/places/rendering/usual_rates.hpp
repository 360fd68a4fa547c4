#pragma once

#include <vector>

#include "holdfast/map/prior_map.hpp"
#include "holdfast/monitor/sight_lines.hpp"
#include "holdfast/places/place.hpp"
#include "holdfast/places/rendering/voxel_window.hpp"
#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::places {

/// The LiDAR that looks round in a map, and how what it sees is judged: as the localizer judges a
/// scan (the defaults of its configuration).
struct ViewOptions {
  int beams = 16;
  int columns = 360;
  float lowest_deg = -15.0F, highest_deg = 15.0F;
  float nearest_m = 0.7F;  ///< nearer returns are not used
  float reach_m = 80.0F;
  float touch_spacings = 1.0F;  ///< a ray hits a point as near to it as that, in MapInfo::spacing_m
  float enclosed_share = 0.3F;  ///< of the level rays that must hit something...
  float enclosed_m = 60.0F;     ///< ...within this: what nothing is known around is no place
  float robust_scale = 3.0F;
  double few_pairs = 20.0;
  registration::AssociationOptions association{.surface_sigma_m = 0.004F};
  int lines_of_sight = 4;  ///< one of so many rays is followed through the planes of the map
  monitor::SightOptions sight;
};

/// Looks round from viewpoints of one tile. Keeps its memory from one to the next.
class View {
 public:
  View(const VoxelWindow& window, const map::PriorMap& map, const ViewOptions& options);

  /// What is usual at `position` (from the map's origin) in the tile `ix`, `iy`, on which `map`
  /// must be focused; none where too little is known around. `seed` draws the noise of the ranges.
  std::optional<Place> from(const Eigen::Vector3f& position, std::int32_t ix, std::int32_t iy,
                            std::uint64_t seed);

 private:
  bool is_enclosed() const;
  void render(std::uint64_t seed);
  void judge(Place& place);
  void follow(Place& place) const;

  const VoxelWindow& window_;
  const map::PriorMap& map_;
  const ViewOptions& options_;
  float touch_m_;
  std::vector<Eigen::Vector3f> directions_;
  std::int32_t ix_ = 0, iy_ = 0;
  Eigen::Vector3f eye_ = Eigen::Vector3f::Zero();  // relative to the map's anchor
  WorkerPool alone_{1};
  registration::BodyPoints seen_;  // relative to the eye
  registration::Correspondences pairs_;
  std::vector<registration::NormalEquations> partials_;
};

}  // namespace holdfast::places
