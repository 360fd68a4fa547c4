#include "simulation/aliases/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace holdfast::simulation {
namespace {

constexpr std::size_t kCoefficients = 10;
constexpr std::size_t kRowStride = 4;
constexpr float kNearest = 0.5F;  // metres: nearer things count as if they were there
constexpr double kApart = 1;      // metres between places that are looked at closely
constexpr double kTurnApart = 20 * std::numbers::pi / 180;
constexpr std::size_t kChunkPlaces = 16;

double squared_distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

void PlaceIndex::add(const RayCaster& caster, const std::vector<Eigen::Vector3d>& positions,
                     WorkerPool& pool) {
  const std::size_t first = places_.size();
  places_.resize(first + positions.size());
  for_each_chunk(pool, positions.size(), kChunkPlaces,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t i = begin; i < end; ++i) {
                     const RangeImage image =
                         render(caster, rays_, {Eigen::Quaterniond::Identity(), positions[i]});
                     const auto inverse = inverse_ranges(image);
                     places_[first + i] = {positions[i], signature_of(inverse), some_rows(inverse)};
                   }
                 });
}

std::vector<float> PlaceIndex::inverse_ranges(const RangeImage& image) const {
  std::vector<float> out;
  out.reserve(image.range.size());
  for (const float range : image.range) {
    out.push_back(range > rays_.max_range_m ? 0 : 1 / std::max(range, kNearest));
  }
  return out;
}

std::vector<float> PlaceIndex::signature_of(const std::vector<float>& inverse) const {
  std::vector<float> out;
  const auto columns = static_cast<double>(rays_.columns);
  for (std::size_t row = 0; row < rays_.elevations.size(); ++row) {
    const float* values = &inverse[row * rays_.columns];
    for (std::size_t k = 0; k < kCoefficients; ++k) {
      const double step = -2 * std::numbers::pi * static_cast<double>(k) / columns;
      const std::complex<double> turn = std::polar(1.0, step);
      std::complex<double> phase = 1, sum = 0;
      for (std::size_t column = 0; column < rays_.columns; ++column, phase *= turn) {
        sum += static_cast<double>(values[column]) * phase;
      }
      out.push_back(static_cast<float>(std::abs(sum) / columns));
    }
  }
  return out;
}

std::vector<float> PlaceIndex::some_rows(const std::vector<float>& inverse) const {
  std::vector<float> out;
  for (std::size_t row = 0; row < rays_.elevations.size(); row += kRowStride) {
    const auto begin = inverse.begin() + static_cast<std::ptrdiff_t>(row * rays_.columns);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(rays_.columns));
  }
  return out;
}

std::vector<std::size_t> PlaceIndex::nearest(const std::vector<float>& signature,
                                             std::size_t count) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    order.emplace_back(squared_distance(signature, places_[i].signature), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> out;
  for (const auto& [distance, i] : order) {
    if (out.size() == count) break;
    const auto is_near = [&, i = i](std::size_t k) {
      return (places_[k].position - places_[i].position).norm() < kApart;
    };
    if (std::none_of(out.begin(), out.end(), is_near)) out.push_back(i);
  }
  return out;
}

void PlaceIndex::best_turns(const std::vector<float>& rows, const Place& place,
                            std::vector<Match>& matches) const {
  const std::size_t columns = rays_.columns;
  std::vector<double> difference(columns, 0);
  for (std::size_t shift = 0; shift < columns; ++shift) {
    float sum = 0;
    for (std::size_t row = 0; row < rows.size(); row += columns) {
      const float* here = &rows[row];
      const float* there = &place.rows[row];
      const std::size_t whole = columns - shift;
      for (std::size_t i = 0; i < whole; ++i) sum += std::abs(here[i] - there[i + shift]);
      for (std::size_t i = whole; i < columns; ++i) sum += std::abs(here[i] - there[i - whole]);
    }
    difference[shift] = sum / static_cast<double>(rows.size());
  }
  const double column_rad = 2 * std::numbers::pi / static_cast<double>(columns);
  const auto best = std::min_element(difference.begin(), difference.end());
  const double turn = column_rad * static_cast<double>(best - difference.begin());
  matches.push_back({place.position, turn, *best});
  for (std::size_t i = 0; i < columns; ++i) {
    const double other = column_rad * static_cast<double>(i);
    if (std::abs(std::remainder(other - turn, 2 * std::numbers::pi)) < kTurnApart) {
      difference[i] = 1e9;
    }
  }
  const auto second = std::min_element(difference.begin(), difference.end());
  matches.push_back(
      {place.position, column_rad * static_cast<double>(second - difference.begin()), *second});
}

std::vector<PlaceIndex::Match> PlaceIndex::similar(const RangeImage& image, std::size_t places,
                                                   std::size_t most) const {
  const auto inverse = inverse_ranges(image);
  const auto rows = some_rows(inverse);
  std::vector<Match> matches;
  for (const std::size_t i : nearest(signature_of(inverse), places)) {
    best_turns(rows, places_[i], matches);
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.difference < b.difference; });
  if (matches.size() > most) matches.resize(most);
  return matches;
}

}  // namespace holdfast::simulation
