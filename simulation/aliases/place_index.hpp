#pragma once

#include <vector>

#include "holdfast/core/parallel.hpp"
#include "simulation/aliases/range_image.hpp"

namespace holdfast::simulation {

/// Finds places that look much like a given one, whichever way one faces: by the magnitudes of the
/// first Fourier coefficients of each row of their inverse ranges, which do not depend on the
/// heading, and among the nearest of those by the rows themselves, at all turns by whole columns.
class PlaceIndex {
 public:
  /// Images are rendered level, facing along the x axis of the map.
  explicit PlaceIndex(const ImageRays& rays) : rays_(rays) {}

  /// Renders and keeps places; in parallel, in the order of `positions`.
  void add(const RayCaster& caster, const std::vector<Eigen::Vector3d>& positions,
           WorkerPool& pool);

  /// A place and how far one has to turn there, counter-clockwise, to see what is seen at the
  /// place asked for.
  struct Match {
    Eigen::Vector3d position;
    double turn_rad = 0;
    double difference = 0;  ///< mean difference of inverse ranges, 1/m
  };
  /// The best matches with the image of a place, best first: up to `most`, from up to `places`
  /// places at least a metre apart, with up to two turns each.
  std::vector<Match> similar(const RangeImage& image, std::size_t places, std::size_t most) const;

 private:
  struct Place {
    Eigen::Vector3d position;
    std::vector<float> signature;
    std::vector<float> rows;  ///< of inverse ranges, some rows only
  };
  std::vector<float> inverse_ranges(const RangeImage& image) const;
  std::vector<float> signature_of(const std::vector<float>& inverse) const;
  std::vector<float> some_rows(const std::vector<float>& inverse) const;
  std::vector<std::size_t> nearest(const std::vector<float>& signature, std::size_t count) const;
  void best_turns(const std::vector<float>& rows, const Place& place,
                  std::vector<Match>& matches) const;

  const ImageRays& rays_;
  std::vector<Place> places_;
};

}  // namespace holdfast::simulation
