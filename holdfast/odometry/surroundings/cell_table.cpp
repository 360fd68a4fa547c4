#include "holdfast/odometry/surroundings/cell_table.hpp"

#include <bit>
#include <cassert>

namespace holdfast::odometry {

void CellTable::reset(std::size_t capacity) {
  const std::size_t slots = std::bit_ceil(2 * capacity);
  entries_.assign(slots, {});
  mask_ = slots - 1;
  shift_ = 64 - std::countr_zero(slots);
}

void CellTable::insert(std::uint64_t key, std::uint32_t index) {
  std::size_t slot = home(key);
  while (entries_[slot].index != kNone) slot = (slot + 1) & mask_;
  entries_[slot] = {key, index, 0};
}

void CellTable::erase(std::uint64_t key) {
  std::size_t hole = home(key);
  while (entries_[hole].key != key) {
    assert(entries_[hole].index != kNone);
    hole = (hole + 1) & mask_;
  }
  // Entries behind the hole move up where that brings them no farther than home.
  for (std::size_t next = (hole + 1) & mask_; entries_[next].index != kNone;
       next = (next + 1) & mask_) {
    const std::size_t from_home = (next - home(entries_[next].key)) & mask_;
    if (from_home < ((next - hole) & mask_)) continue;
    entries_[hole] = entries_[next];
    hole = next;
  }
  entries_[hole] = {};
}

}  // namespace holdfast::odometry
