#include "holdfast/io/clouds/lzf.hpp"

#include <cstdint>
#include <cstring>

namespace holdfast::io::clouds {
namespace {

// A token begins with a control byte c. c < 32: c + 1 literal bytes follow. Else a copy from what
// has been unpacked: the upper three bits hold its length - 2 (7: the next byte is added), the
// lower five and the next byte its distance - 1.
constexpr unsigned kLiteralEnd = 32;
constexpr unsigned kLongLength = 7;
// A token of three bytes copies at most 264; anything above cannot be LZF.
constexpr std::size_t kMostExpansion = 88;

}  // namespace

bool lzf_decompress(std::string_view packed, std::size_t size, std::string& out) {
  if (size / kMostExpansion > packed.size()) return false;
  out.resize(size);
  std::size_t in = 0;
  std::size_t at = 0;
  const auto byte = [&packed](std::size_t i) { return static_cast<unsigned char>(packed[i]); };
  while (in < packed.size()) {
    const unsigned control = byte(in++);
    if (control < kLiteralEnd) {
      const std::size_t count = control + 1;
      if (count > packed.size() - in || count > size - at) return false;
      std::memcpy(&out[at], &packed[in], count);
      in += count;
      at += count;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == kLongLength) {
      if (in == packed.size()) return false;
      length += byte(in++);
    }
    length += 2;
    if (in == packed.size()) return false;
    const std::size_t distance = ((control & 31U) << 8) + byte(in++) + 1;
    if (distance > at || length > size - at) return false;
    // Source and target may overlap (a run), so byte by byte.
    for (std::size_t i = 0; i < length; ++i, ++at) out[at] = out[at - distance];
  }
  return at == size;
}

}  // namespace holdfast::io::clouds
