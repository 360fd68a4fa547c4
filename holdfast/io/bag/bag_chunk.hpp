#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace holdfast::io::bag {

/// Memory that grows without being cleared or copied.
class Buffer {
 public:
  /// Makes room for `size` bytes, whose content is undefined.
  char* make_room(std::size_t size);
  void set_size(std::size_t size) { size_ = size; }
  std::string_view bytes() const { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

/// How far the content of a chunk came out.
enum class Unpacked { kWhole, kEndsEarly, kDamaged };

enum class Compression : std::uint8_t { kNone, kBz2, kLz4, kUnknown };

Compression parse_compression(std::string_view name);

/// Unpacks a compressed chunk that should have `size` bytes. Data that ends early yields what can
/// be had; damaged data yields nothing.
Unpacked unpack_chunk(Compression compression, std::string_view packed, std::size_t size,
                      Buffer& out);

/// The bytes as one LZ4 frame, as bags hold them.
std::string pack_lz4(std::string_view bytes);

}  // namespace holdfast::io::bag
