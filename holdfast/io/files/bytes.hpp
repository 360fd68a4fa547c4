#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

static_assert(std::endian::native == std::endian::little,
              "logs and clouds are little endian and are read without swapping");

namespace holdfast::io::files {

/// The T whose little-endian bytes begin at `at`, which need not be aligned.
template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

template <class T>
void append(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

/// Appends a length of 32 bits and the text, as ROS serialises strings and records.
inline void append_counted(std::string& out, std::string_view text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

/// Reads numbers and strings from bytes without ever leaving them: after a read past the end ok()
/// is false, and everything read is zero or empty.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t left() const { return rest_.size(); }
  const char* at() const { return rest_.data(); }

  template <class T>
  T number() {
    const std::string_view raw = bytes(sizeof(T));
    return ok_ ? load<T>(raw.data()) : T{};
  }

  std::string_view bytes(std::size_t size) {
    if (!ok_ || size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  /// A length of 32 bits and as many bytes.
  std::string_view counted() {
    const auto size = number<std::uint32_t>();
    return bytes(size);
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace holdfast::io::files
