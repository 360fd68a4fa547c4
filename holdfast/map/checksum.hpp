#pragma once

#include <cstddef>
#include <cstdint>

namespace holdfast::map {

/// XXH3-64 of a block of memory.
std::uint64_t checksum(const void* data, std::size_t bytes);

}  // namespace holdfast::map
