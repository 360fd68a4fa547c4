#pragma once

#include <optional>
#include <vector>

#include "holdfast/core/se3.hpp"
#include "holdfast/relocalization/search_report.hpp"

namespace holdfast::relocalization {

/// What a robot found by a confirmed search is taken to be.
struct Confirmed {
  Candidate candidate;     ///< its pose is at the time of the last search
  double probability = 0;  ///< after all searches
};

/// Follows the candidates of one search after the other by the odometry, until one of them is sure:
/// what one place explains as well as another, the next metres of way tell apart. Of the words of a
/// search counts what is news since the one before (as in monitor::Belief), so that a robot that
/// stands does not grow sure of anything by looking again.
class Confirmation {
 public:
  /// `accept_probability` as in SearchConfig.
  explicit Confirmation(double accept_probability) : accept_probability_(accept_probability) {}

  /// What a search found at `T_odom_body`; all since the last reset() are of one epoch of the
  /// odometry. Searches that gave up, had too little to go by, or found no pose that fits say
  /// nothing: what they do not see may still be there.
  void hear(const SearchReport& report, const SE3& T_odom_body, double seconds_since_last);

  /// The pose that is sure by now, determined in every direction, and which the last search by
  /// itself holds for 9 times as likely as none: searches with a window of scans that an odometry
  /// put together wrongly are wrong together, and their words do not add up.
  std::optional<Confirmed> confirmed() const;

  void reset() { *this = Confirmation(accept_probability_); }

  /// How likely each one is that stands, the newest search's candidates among them; for records.
  std::size_t standing() const { return hypotheses_.size(); }

 private:
  struct Hypothesis {
    SE3 T_map_odom;
    Candidate last;        ///< as a search last saw it
    double log_odds = 0;   ///< of all searches, against being elsewhere
    bool seen_now = true;  ///< by the last search...
    bool fits_now = true;  ///< ...which held it for likelier than none
  };

  Hypothesis* find(const SE3& T_map_odom);
  double probability(const Hypothesis& hypothesis) const;

  double accept_probability_;
  std::vector<Hypothesis> hypotheses_;
  SE3 last_T_odom_body_;
  double absent_log_odds_ = 0;  ///< of one that no search saw
  bool any_ = false;
};

}  // namespace holdfast::relocalization
