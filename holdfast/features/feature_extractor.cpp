#include "holdfast/features/features.hpp"
#include "holdfast/features/row_fit.hpp"
#include "holdfast/features/row_links.hpp"
#include "holdfast/features/scan_rows.hpp"
#include "holdfast/features/smoothness.hpp"

namespace holdfast::features {

struct FeatureExtractor::Work {
  Work(const FeatureConfig& config, const RangeNoise& noise)
      : fitter(config, noise), linker(config) {}

  RowSorter sorter;
  RowFitter fitter;
  RowLinker linker;
  ScanRows rows;
  std::vector<WindowFit> fits;
  std::vector<RowEdge> edges;
  std::vector<double> smoothness;
};

FeatureExtractor::FeatureExtractor(const FeatureConfig& config, double range_sigma_m)
    : config_(config),
      work_(std::make_unique<Work>(
          config, RangeNoise{range_sigma_m, config.range_sigma_per_m, config.beam_spread_rad})) {}

FeatureExtractor::~FeatureExtractor() = default;
FeatureExtractor::FeatureExtractor(FeatureExtractor&&) noexcept = default;
FeatureExtractor& FeatureExtractor::operator=(FeatureExtractor&&) noexcept = default;

void FeatureExtractor::extract(const Scan& scan, Features& out) {
  work_->sorter.sort(scan, work_->rows);
  classify(out);
}

void FeatureExtractor::extract(const std::vector<Eigen::Vector3f>& points,
                               const std::vector<std::uint16_t>& rings, Features& out) {
  work_->sorter.sort(points, rings, work_->rows);
  classify(out);
}

void FeatureExtractor::classify(Features& out) {
  Work& w = *work_;
  out.edges.clear();
  out.planes.clear();
  if (config_.smoothness != "fitted") {
    const bool logarithmic = config_.smoothness == "log";
    classify_by_smoothness(w.rows, config_, logarithmic, w.smoothness, out);
    return;
  }
  w.edges.clear();
  w.fitter.fit(w.rows, w.fits, w.edges);
  w.linker.find_planes(w.rows, w.fits, out.planes);
  w.linker.direct_edges(w.rows, w.edges, out.edges);
}

}  // namespace holdfast::features
