#pragma once

#include "holdfast/core/fields.hpp"
#include "holdfast/monitor/evidence/hypotheses.hpp"
#include "holdfast/monitor/evidence/onset.hpp"

namespace holdfast::monitor {

/// How the truth changes by itself, and how soon what is seen is news. Probabilities a second.
struct BeliefConfig {
  double wrong_at_start = 0.05;
  double wrong_per_s = 1e-4;
  double wrong_after_break = 0.1;
  double found_again_per_s = 3e-3;
  double news_after_m = 1.0;
  double news_after_s = 5.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("wrong_at_start", self.wrong_at_start,
          FieldDoc{"probability that the pose at the start is of another place", 1e-6, 0.5});
    visit("wrong_per_s", self.wrong_per_s,
          FieldDoc{"probability that a pose becomes wrong in a second (1e-4: once in three hours)",
                   1e-12, 0.1});
    visit(
        "wrong_after_break", self.wrong_after_break,
        FieldDoc{"probability that the robot was carried, where the odometry says so", 1e-6, 0.99});
    visit("found_again_per_s", self.found_again_per_s,
          FieldDoc{"probability that a wrong pose becomes right in a second without a search", 1e-9,
                   0.1});
    visit("news_after_m", self.news_after_m,
          FieldDoc{"way after which a scan shows something new", 1e-3, 100.0});
    visit("news_after_s", self.news_after_s,
          FieldDoc{"likewise the time, for a robot that stands", 0.1, 1000.0});
  }
};

/// Probabilities of the hypotheses after a sequence of scans that are not independent of each
/// other. The newest scan counts in full; of each scan that part becomes history which is news
/// against the one before: 1 - exp(-way / news_after_m - time / news_after_s). So a robot that
/// stands does not become ever surer from the same view, and one carried away does not have to
/// outweigh what was seen before.
class Belief {
 public:
  explicit Belief(const BeliefConfig& config);

  /// Time passes, and way, with what may be a sign that the robot was carried.
  void pass(double seconds, double way_m, const Onset& onset);
  /// What the newest scan says: of the scene, and of the way of the last seconds. The way is news
  /// only once all of it is new.
  void hear(const LogLikelihoods& scene, const LogLikelihoods& way);

  double probability(Hypothesis hypothesis) const {
    return now_[static_cast<std::size_t>(hypothesis)];
  }
  double p_wrong() const;

  /// How much more likely a testimony is at a wrong pose than at a right one, as a logarithm, given
  /// what else is believed: which kind of wrong, which kind of right.
  double log_ratio(const LogLikelihoods& testimony) const;

 private:
  using Probabilities = std::array<double, kHypotheses>;

  double p_carried(double seconds, const Onset& onset) const;

  BeliefConfig config_;
  Probabilities history_;  ///< without the newest scan
  Probabilities now_;      ///< with it
  double news_ = 1;        ///< share of the newest scan that is
};

}  // namespace holdfast::monitor
