#pragma once

#include <span>
#include <string>
#include <string_view>

#include "evaluation/evaluate.hpp"

namespace holdfast::evaluation {

/// One figure of a result: the one place that knows its key, meaning, unit and where it comes from.
/// JSON, table, report and reference all walk this list.
struct ResultKey {
  enum class Unit { kCount, kLength, kAngle, kShare, kPercent, kSeconds };
  std::string_view key;    ///< stable name in JSON
  std::string_view label;  ///< for people
  std::string_view meaning;
  Unit unit;
  double (*value)(const Evaluation&);  ///< NaN if not known
};

std::span<const ResultKey> result_keys();

/// The figure with its unit, for people.
std::string value_text(const ResultKey& key, const Evaluation& evaluation);

/// The result as a JSON object: all result_keys() (null where not known), the 95 % intervals of the
/// shares (`coverage_ci95: [low, high]`, ...), `align`, `T_truth_estimate` (x y z qx qy qz qw),
/// `events` (event, t0, t1, moved_m, moved_deg, noticed_after_s, recovery_s, worst_claim_m,
/// misleading_scans), `relocalizations` (t, error_m, error_deg) and `warnings`.
std::string result_json(const Evaluation& evaluation);

/// All keys with unit and meaning, one a line.
std::string result_key_reference();

}  // namespace holdfast::evaluation
