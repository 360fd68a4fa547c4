#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/io/bag/bag_records.hpp"
#include "holdfast/io/files/input_file.hpp"

namespace holdfast::io::bag {

/// Where a record stands in the file; only its header is in memory.
struct RecordPlace {
  std::string header;
  std::uint64_t data = 0;  ///< position of its data
  std::uint32_t data_size = 0;

  Fields fields() const { return Fields(header); }
  std::uint64_t end() const { return data + data_size; }
};

/// Reads records at any place of a bag, with one look-ahead for those that stand close together.
class RecordWalker {
 public:
  explicit RecordWalker(const files::InputFile& file) : file_(file) {}

  /// The record that begins at `position`; empty if the file ends in its header. Its data may reach
  /// beyond the end of the file.
  std::optional<RecordPlace> record_at(std::uint64_t position);

  /// The data of a record; empty if the file ends in it. Valid until the next call.
  std::optional<std::string_view> data_of(const RecordPlace& record);

 private:
  /// `size` bytes at `position`; empty if the file ends before.
  std::optional<std::string_view> view(std::uint64_t position, std::size_t size);

  const files::InputFile& file_;
  std::string window_;
  std::uint64_t window_begin_ = 0;
};

}  // namespace holdfast::io::bag
