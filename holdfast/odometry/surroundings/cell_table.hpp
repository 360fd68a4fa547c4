#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace holdfast::odometry {

/// Cell coordinates as one number; each within +-2^20.
inline std::uint64_t cell_key(const Eigen::Vector3i& cell) {
  constexpr int kOffset = 1 << 20;
  constexpr std::uint64_t kMask = (1U << 21) - 1;
  return ((static_cast<std::uint64_t>(cell.x() + kOffset) & kMask) << 42) |
         ((static_cast<std::uint64_t>(cell.y() + kOffset) & kMask) << 21) |
         (static_cast<std::uint64_t>(cell.z() + kOffset) & kMask);
}

/// The cell of a key.
inline Eigen::Vector3i cell_of(std::uint64_t key) {
  constexpr int kOffset = 1 << 20;
  constexpr std::uint64_t kMask = (1U << 21) - 1;
  return {static_cast<int>((key >> 42) & kMask) - kOffset,
          static_cast<int>((key >> 21) & kMask) - kOffset, static_cast<int>(key & kMask) - kOffset};
}

/// Where the cell of a key stands: open addressing with linear probing in memory of a fixed size,
/// never more than half full.
class CellTable {
 public:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  struct Entry {
    std::uint64_t key = UINT64_MAX;  // no cell has this key
    std::uint32_t index = kNone;
    std::uint32_t flags = 0;  ///< the owner's, so that it need not look at the cell for them
  };

  /// Makes room for `capacity` entries and forgets all.
  void reset(std::size_t capacity);

  /// The entry of `key`; one with the index kNone if there is none.
  const Entry& look_up(std::uint64_t key) const {
    for (std::size_t slot = home(key);; slot = (slot + 1) & mask_) {
      const Entry& entry = entries_[slot];
      if (entry.key == key || entry.index == kNone) return entry;
    }
  }
  /// Has the memory of `key` fetched while something else is done.
  void prefetch(std::uint64_t key) const { __builtin_prefetch(&entries_[home(key)]); }
  /// Index stored with `key`; kNone if there is none.
  std::uint32_t find(std::uint64_t key) const { return look_up(key).index; }
  /// `key` must not be there yet; the number of entries stays within the capacity.
  void insert(std::uint64_t key, std::uint32_t index);
  /// `key` must be there.
  void set_flags(std::uint64_t key, std::uint32_t flags) {
    entries_[static_cast<std::size_t>(&look_up(key) - entries_.data())].flags = flags;
  }
  /// `key` must be there.
  void erase(std::uint64_t key);

  std::size_t memory_bytes() const { return entries_.size() * sizeof(Entry); }

 private:
  std::size_t home(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> shift_);
  }

  std::vector<Entry> entries_;
  std::size_t mask_ = 0;
  int shift_ = 63;
};

}  // namespace holdfast::odometry
