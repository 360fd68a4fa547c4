#pragma once

#include <array>
#include <cstdint>

namespace holdfast::relocalization {

/// Counts up to 1023 set bits for each of 64 lanes at once: plane k holds bit k of all counts.
/// Words are added eight at a time by carry-save adders (Harley and Seal).
class LaneCounter {
 public:
  static constexpr int kPlanes = 10;

  void add8(const std::uint64_t (&w)[8]) {
    std::uint64_t two_a, two_b, four_a, four_b, eight;
    add(w[0], w[1], planes_[0], two_a);
    add(w[2], w[3], planes_[0], two_b);
    add(two_a, two_b, planes_[1], four_a);
    add(w[4], w[5], planes_[0], two_a);
    add(w[6], w[7], planes_[0], two_b);
    add(two_a, two_b, planes_[1], four_b);
    add(four_a, four_b, planes_[2], eight);
    for (int k = 3; eight != 0 && k < kPlanes; ++k) {
      const std::uint64_t carry = planes_[k] & eight;
      planes_[k] ^= eight;
      eight = carry;
    }
  }

  /// The largest count of the lanes of `mask`.
  int largest(std::uint64_t mask) const {
    int count = 0;
    for (int k = kPlanes - 1; k >= 0; --k) {
      const std::uint64_t set = mask & planes_[k];
      if (set == 0) continue;
      mask = set;
      count |= 1 << k;
    }
    return count;
  }

  /// Lanes with at least `limit`.
  std::uint64_t at_least(int limit) const {
    std::uint64_t more = 0, same = ~std::uint64_t{0};
    for (int k = kPlanes - 1; k >= 0; --k) {
      if ((limit >> k & 1) == 0) {
        more |= same & planes_[k];
        same &= ~planes_[k];
      } else {
        same &= planes_[k];
      }
    }
    return more | same;
  }

  int count(int lane) const {
    int count = 0;
    for (int k = 0; k < kPlanes; ++k) count |= static_cast<int>(planes_[k] >> lane & 1U) << k;
    return count;
  }

 private:
  /// Adds two words to one plane: the sum stays, what is carried goes to `carry`.
  static void add(std::uint64_t a, std::uint64_t b, std::uint64_t& sum, std::uint64_t& carry) {
    const std::uint64_t half = sum ^ a;
    carry = (sum & a) | (half & b);
    sum = half ^ b;
  }

  std::array<std::uint64_t, kPlanes> planes_{};
};

}  // namespace holdfast::relocalization
