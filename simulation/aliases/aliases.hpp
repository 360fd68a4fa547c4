#pragma once

#include <string>
#include <vector>

#include "simulation/simulation.hpp"

/// Aliases: other places of a world where a scan looks the same within noise. No localizer can tell
/// them from the true one by a scan alone, so that answers there are scored apart.
namespace holdfast::simulation {

struct AliasModel {
  double every_m = 1;      ///< of the drive, a pose is asked about; 0: at each scan
  double station_m = 0.5;  ///< between the places along the route that may be aliases
  double aside_m = 1.5;    ///< and how far to both sides, where nothing stands
  std::size_t rows = 16;   ///< of the images that are compared
  std::size_t columns = 360;
  std::size_t places = 30;  ///< that are looked at closely, of those most like the one asked about
  std::size_t verified = 10;   ///< of these, refined and verified
  double differing_share = 0;  ///< of the rays, beyond what noise explains, that may differ
};

/// A stretch of a drive that looks like other places, all the while in the same way.
struct AliasedStretch {
  TimeNs t0 = 0;
  TimeNs t1 = 0;
  /// T_map_body of the places that look like the one at t0. At a later time t of the stretch the
  /// alias is at pose * T_map_body(t0)^-1 * T_map_body(t).
  std::vector<SE3> poses;
};

/// Finds the aliased stretches of a drive, in order of time. Images of the world as driven, without
/// people, are rendered at places along the route and beside it; those most like the image at a
/// true pose (for any heading) are refined, and verified by the share of rays that differ by more
/// than 4 sigma: not more than noise would explain. Places less than 1 m and 15 degrees away are
/// the place itself. A place elsewhere than `aside_m` from the route is not found, nor one that
/// looks alike only because surfaces gave no return. Same simulation, same stretches, for any
/// number of threads; takes some seconds a hundred metres.
std::vector<AliasedStretch> find_aliases(const Simulation& simulation, const AliasModel& model);

/// One line of aliases.jsonl: {"t0":s,"t1":s,"poses":[[x,y,z,qx,qy,qz,qw],...]}.
std::string alias_json(const AliasedStretch& stretch);

}  // namespace holdfast::simulation
