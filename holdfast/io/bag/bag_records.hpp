#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "holdfast/core/time.hpp"
#include "holdfast/io/files/bytes.hpp"

/// Records of the ROS bag format 2.0 (wiki.ros.org/Bags/Format/2.0): a header of named fields, then
/// data, each behind its length of 32 bits.
namespace holdfast::io::bag {

inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

enum class Op : std::uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// The fields of a record's header, or of a connection's data: (length, "name=value") pairs.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : bytes_(bytes) {}

  std::optional<std::string_view> find(std::string_view name) const;

  /// The value as a number; empty if there is none of this size.
  template <class T>
  std::optional<T> number(std::string_view name) const {
    const auto value = find(name);
    if (!value || value->size() != sizeof(T)) return std::nullopt;
    return files::load<T>(value->data());
  }

  std::optional<Op> op() const;
  /// A time of the bag format: seconds and nanoseconds of 32 bits each.
  std::optional<TimeNs> time(std::string_view name) const;

 private:
  std::string_view bytes_;
};

struct Record {
  Fields header{{}};
  std::string_view data;
};

/// The record at the reader's place; empty if the bytes end in it.
std::optional<Record> take_record(files::ByteReader& reader);

/// Puts record headers and whole records together, for writing.
void append_field(std::string& out, std::string_view name, std::string_view value);
template <class T>
void append_number_field(std::string& out, std::string_view name, T value) {
  std::string bytes;
  files::append(bytes, value);
  append_field(out, name, bytes);
}
void append_op(std::string& out, Op op);
/// Seconds and nanoseconds; `t` must lie in [0, 2^32) seconds.
void append_time(std::string& out, TimeNs t);

}  // namespace holdfast::io::bag
