#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace holdfast {

/// A named, seeded stream of random numbers: same seed and name, same numbers on every platform,
/// and streams of different names are independent, so that a new consumer never shifts an old one.
/// xoshiro256++ (Blackman and Vigna, 2019), seeded by SplitMix64 from an FNV-1a hash of the name.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t next_u64();
  /// Uniform in [0, 1) with 53 random bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, n); n > 0.
  std::uint64_t below(std::uint64_t n) { return next_u64() % n; }
  /// Standard normal (Marsaglia's polar method).
  double normal();
  double normal(double mean, double sigma) { return mean + sigma * normal(); }

 private:
  std::array<std::uint64_t, 4> state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace holdfast
