#include "holdfast/map/checksum.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace holdfast::map {

std::uint64_t checksum(const void* data, std::size_t bytes) { return XXH3_64bits(data, bytes); }

}  // namespace holdfast::map
