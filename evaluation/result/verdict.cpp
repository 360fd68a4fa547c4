#include "evaluation/result/verdict.hpp"

#include <fmt/core.h>

#include "evaluation/result/number_text.hpp"

namespace holdfast::evaluation {
namespace {

using Light = Verdict::Light;

std::string figures(const Evaluation& e) {
  return fmt::format("{} RMSE over {}, {} at worst; {} of the scans have a pose",
                     length_text(e.trans_m.rmse), length_text(e.path_m), length_text(e.trans_m.max),
                     share_text(e.coverage.value()));
}

Verdict nothing_claimed(std::size_t scans) {
  return {Light::kRed, "No pose was claimed",
          fmt::format("{} scans were due.", count_text(static_cast<double>(scans)))};
}

Verdict judge_odometry(const Evaluation& e) {
  const RelativeError& drift = e.drift[0];
  const std::string text =
      drift.segments > 0 ? fmt::format(", drift {} over 10 m", length_text(drift.trans_rmse_m))
                         : std::string();
  return {Light::kNone, fmt::format("{} RMSE after alignment", length_text(e.trans_m.rmse)),
          figures(e) + text + "."};
}

Verdict misleading_verdict(const Evaluation& e) {
  return {
      Light::kRed,
      fmt::format("Misleading in {} scans", count_text(static_cast<double>(e.misleading.count))),
      fmt::format("{} of the scans were trusted while over 0.5 m or 5 deg wrong, {} at worst; "
                  "{} have a pose.",
                  share_text(e.misleading.value()), length_text(e.trans_m.max),
                  share_text(e.coverage.value()))};
}

}  // namespace

Verdict judge(const Evaluation& e) {
  if (e.claimed == 0) return nothing_claimed(e.scans);
  if (e.align == Alignment::kRigid) return judge_odometry(e);
  if (e.misleading.count > 0) return misleading_verdict(e);
  if (e.false_relocalizations > 0)
    return {Light::kRed, "Relocalized at a wrong place",
            fmt::format("{} accepted relocalizations were wrong; {}.", e.false_relocalizations,
                        figures(e))};
  const std::string never = "; never misleading.";
  const double success = e.success.value();
  const double coverage = e.coverage.value();
  if (success < 0.9 || coverage < 0.9)
    return {Light::kRed, fmt::format("Localized in {} of the scans", share_text(success)),
            figures(e) + never};
  if (success < 0.99 || coverage < 0.99 || e.trusted.value() < 0.995)
    return {Light::kAmber, fmt::format("Localized to {}, with gaps", length_text(e.trans_m.rmse)),
            figures(e) + never};
  return {Light::kGreen, fmt::format("Localized to {}", length_text(e.trans_m.rmse)),
          figures(e) + never};
}

Verdict judge_without_truth(const std::vector<ScanRecord>& scans, bool statuses_known) {
  Share trusted;
  Share claimed;
  for (const ScanRecord& scan : scans) {
    claimed.add(scan.claimed);
    trusted.add(scan.claimed && status_is_trusted(scan.status));
  }
  if (claimed.count == 0) return nothing_claimed(scans.size());
  const double share = statuses_known ? trusted.value() : claimed.value();
  const Light light = share >= 0.99 ? Light::kNone : share >= 0.9 ? Light::kAmber : Light::kRed;
  const std::string poses = share_text(claimed.value()) + " of the scans";
  if (!statuses_known)
    return {light, "A pose for " + poses, "There is no truth to judge it against."};
  return {light, fmt::format("Tracking {} of the drive", share_text(share)),
          fmt::format("By its own account; {} have a pose. There is no truth to judge it against.",
                      poses)};
}

std::string_view light_name(Light light) {
  switch (light) {
    case Light::kGreen: return "good";
    case Light::kAmber: return "fair";
    case Light::kRed: return "bad";
    case Light::kNone: return "none";
  }
  return "none";
}

}  // namespace holdfast::evaluation
