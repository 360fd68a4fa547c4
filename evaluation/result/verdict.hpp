#pragma once

#include <string>
#include <string_view>

#include "evaluation/evaluate.hpp"

namespace holdfast::evaluation {

/// The result in one line, with a traffic light.
struct Verdict {
  enum class Light { kGreen, kAmber, kRed, kNone };
  Light light = Light::kNone;
  std::string headline;  ///< a few words: "Localized to 1.9 mm"
  std::string sentence;  ///< why, with figures
};

/// Red: nothing claimed, any misleading scan or false relocalization, success or coverage under 90
/// %. Amber: success or coverage under 99 %, or trusted for less than 99.5 % of the scans. No
/// light: an aligned odometry, whose errors have no limit to be held to.
Verdict judge(const Evaluation& evaluation);

/// Without a truth: what the run says of itself, from the scans' statuses if those are known. Never
/// green.
Verdict judge_without_truth(const std::vector<ScanRecord>& scans, bool statuses_known);

/// "good", "fair", "bad", "none".
std::string_view light_name(Verdict::Light light);

}  // namespace holdfast::evaluation
