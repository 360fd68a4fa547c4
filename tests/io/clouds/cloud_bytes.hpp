#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/files/bytes.hpp"

/// Bytes of clouds put together by hand, so that tests do not trust the writer.
namespace holdfast::io::testing {

template <class T>
void append_big_endian(std::string& out, T value) {
  std::string bytes;
  files::append(bytes, value);
  out.append(bytes.rbegin(), bytes.rend());
}

/// LZF with literals and runs: enough to make both kinds of tokens, near and far copies.
inline std::string lzf_pack(std::string_view bytes) {
  std::string packed;
  std::string literals;
  const auto flush = [&] {
    for (std::size_t i = 0; i < literals.size(); i += 32) {
      const auto part = literals.substr(i, 32);
      packed.push_back(static_cast<char>(part.size() - 1));
      packed += part;
    }
    literals.clear();
  };
  for (std::size_t i = 0; i < bytes.size();) {
    // The longest copy from up to 8192 bytes back, 3 to 264 bytes long.
    std::size_t best = 0, distance = 0;
    for (std::size_t back = 1; back <= std::min<std::size_t>(i, 8192); ++back) {
      std::size_t length = 0;
      while (length < 264 && i + length < bytes.size() &&
             bytes[i + length] == bytes[i + length - back]) {
        ++length;
      }
      if (length > best) best = length, distance = back;
    }
    if (best < 3) {
      literals.push_back(bytes[i++]);
      continue;
    }
    flush();
    const std::size_t length = best - 2, offset = distance - 1;
    packed.push_back(static_cast<char>((std::min<std::size_t>(length, 7) << 5) | (offset >> 8)));
    if (length >= 7) packed.push_back(static_cast<char>(length - 7));
    packed.push_back(static_cast<char>(offset & 255));
    i += best;
  }
  flush();
  return packed;
}

}  // namespace holdfast::io::testing
