#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/monitor/evidence/looks.hpp"
#include "holdfast/registration/levenberg_marquardt.hpp"

namespace holdfast::relocalization {

/// Sectors of yaw in the body frame; below 0 where next to nothing is seen.
inline constexpr std::size_t kSectors = 24;
using SectorShares = std::array<float, kSectors>;

/// A pose that the search looked at closely: refined against the planes of the map.
struct Candidate {
  SE3 T_map_body;
  double gridded_score = 0;    ///< share of the search's points that hit an occupied cell
  monitor::Looks seen;         ///< of the refined pose
  monitor::UsualLooks usual;   ///< at the nearest place of the map
  double agreeing_share = 0;   ///< mean robust weight over all points
  double explained = 0;        ///< share of what the points could say for a pose, at most
  SectorShares by_sector{};    ///< likewise of the points of each sector of directions
  double weakest_sigma_m = 0;  ///< of the position, along the direction known worst
  double log_odds = 0;         ///< ln of how much likelier what is seen is here than elsewhere
  double probability = 0;      ///< among all candidates, and that it is none of them
  registration::Matrix6d covariance = registration::Matrix6d::Zero();  ///< [p in map, R exp(phi)]
};

enum class SearchOutcome : std::uint8_t {
  kFound,      ///< one pose explains what is seen, and no other does
  kAmbiguous,  ///< several do, or the one is not determined in every direction
  kNothing,    ///< none does
  kTooPoor,    ///< the query does not say enough to be searched for
  kOutOfWork   ///< the limit of work was reached: no answer
};

/// "found", "ambiguous", ...
const char* name_of(SearchOutcome outcome);

/// What a search found. Everything but `T_map_body` is there to be shown and recorded.
struct SearchReport {
  SearchOutcome outcome = SearchOutcome::kNothing;
  std::optional<SE3> T_map_body;      ///< at the query's time; only if kFound
  double probability = 0;             ///< of the best candidate
  std::vector<Candidate> candidates;  ///< the likeliest first; poses that coincide are one
  std::string reason;                 ///< a sentence, for people
  std::uint64_t work = 0;  ///< elementary look-ups: a deterministic measure of the time taken

  /// That the pose is none of the candidates.
  double p_none() const;
  /// Does this search by itself hold the candidate for at least 9 times as likely as none of them?
  bool fits(const Candidate& candidate) const;
  bool any_fits() const;
};

}  // namespace holdfast::relocalization
