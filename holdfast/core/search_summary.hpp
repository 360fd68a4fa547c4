#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/core/time.hpp"

namespace holdfast {

/// A search of the whole map for the robot's pose (article 3.4.2), as the report of the step tells
/// it in which it took effect.
struct SearchSummary {
  struct Candidate {
    SE3 T_map_body;           ///< at the time of the search's newest scan
    double score = 0;         ///< of the search on the grid
    double agreeing = 0;      ///< mean robust weight of the points, once refined
    double probability = 0;   ///< among all candidates, and that it is none of them
  };

  TimeNs t = 0;                       ///< of the newest scan that was searched with
  int scans = 0;                      ///< that was done with
  std::string outcome;                ///< "found", "ambiguous", "nothing", ...
  std::string reason;                 ///< a sentence
  std::vector<Candidate> candidates;  ///< the likeliest first
  std::uint64_t work = 0;             ///< look-ups
  double latency_s = 0;               ///< by the work: from `t` until it took effect, or could have
  double cpu_ms = 0;                  ///< as measured; nothing depends on it
  bool accepted = false;              ///< the pose was taken over
};

}  // namespace holdfast
