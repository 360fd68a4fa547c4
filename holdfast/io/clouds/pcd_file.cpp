#include "holdfast/io/clouds/pcd_file.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>
#include <vector>

#include "holdfast/io/clouds/lzf.hpp"
#include "holdfast/io/clouds/point_fields.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/numbers.hpp"

namespace holdfast::io::clouds {
namespace {

using files::error_at;
using files::ScalarType;

constexpr std::size_t kMostFields = 1000;
constexpr std::size_t kMostPerPoint = 100'000;

struct PcdHeader {
  std::vector<std::string_view> names, sizes, types, counts;
  std::optional<std::size_t> width, height, points;
  std::string_view data;
  std::size_t lines = 0;  ///< of the header
};

/// A size that must fit in 2^40, so that products with strides cannot overflow.
Result<std::size_t> parse_size(const std::filesystem::path& path, std::string_view key,
                               const std::vector<std::string_view>& words) {
  const auto value = words.size() == 2 ? files::parse_integer(words[1]) : std::nullopt;
  if (!value || *value < 0 || *value > (1LL << 40)) {
    return error_at(path, "{} '{}' is not a number of points", key,
                    words.size() > 1 ? words[1] : "");
  }
  return static_cast<std::size_t>(*value);
}

Result<PcdHeader> parse_header(const std::filesystem::path& path, std::string_view& rest) {
  PcdHeader header;
  std::string_view line;
  while (header.data.empty()) {
    if (!files::take_line(rest, line)) return error_at(path, "ends before the header's DATA line");
    ++header.lines;
    auto words = files::split_words(line);
    if (words.empty() || words[0][0] == '#') continue;
    const auto key = words[0];
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (key == "FIELDS" || key == "COLUMNS")
      header.names = values;
    else if (key == "SIZE")
      header.sizes = values;
    else if (key == "TYPE")
      header.types = values;
    else if (key == "COUNT")
      header.counts = values;
    else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      const auto size = parse_size(path, key, words);
      if (!size) return size.error();
      (key == "WIDTH" ? header.width : key == "HEIGHT" ? header.height : header.points) = *size;
    } else if (key == "DATA") {
      if (values.empty()) return error_at(path, "the header's DATA line is empty");
      header.data = values[0];
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      return error_at(path, "line {}: '{}' is not a line of a PCD header", header.lines,
                      key.substr(0, 40));
    }
  }
  return header;
}

std::optional<ScalarType> scalar_type(std::string_view type, std::string_view size) {
  using Type = ScalarType;
  constexpr std::pair<std::string_view, Type> kTypes[] = {
      {"I1", Type::kInt8},    {"U1", Type::kUint8},  {"I2", Type::kInt16}, {"U2", Type::kUint16},
      {"I4", Type::kInt32},   {"U4", Type::kUint32}, {"I8", Type::kInt64}, {"U8", Type::kUint64},
      {"F4", Type::kFloat32}, {"F8", Type::kFloat64}};
  const auto key = std::string(type) + std::string(size);
  for (const auto& [name, value] : kTypes) {
    if (name == key) return value;
  }
  return std::nullopt;
}

Result<PointFields> header_fields(const std::filesystem::path& path, const PcdHeader& header) {
  const std::size_t n = header.names.size();
  if (n == 0 || n > kMostFields) return error_at(path, "the header names {} FIELDS", n);
  if (header.sizes.size() != n || header.types.size() != n ||
      (!header.counts.empty() && header.counts.size() != n)) {
    return error_at(path, "the header has {} FIELDS but {} SIZE, {} TYPE and {} COUNT values", n,
                    header.sizes.size(), header.types.size(), header.counts.size());
  }
  std::vector<PointField> fields(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto type = scalar_type(header.types[i], header.sizes[i]);
    const auto count = header.counts.empty() ? 1 : files::parse_integer(header.counts[i]);
    if (!type) {
      return error_at(path,
                      "field '{}' has TYPE {} SIZE {}, expected I, U or F of 1, 2, 4, 8 bytes",
                      header.names[i], header.types[i], header.sizes[i]);
    }
    if (!count || *count < 1 || static_cast<std::size_t>(*count) > kMostPerPoint) {
      return error_at(path, "field '{}' has COUNT {}", header.names[i], header.counts[i]);
    }
    fields[i].name = header.names[i];
    fields[i].type = *type;
    fields[i].count = static_cast<std::size_t>(*count);
  }
  return arrange_fields(path, std::move(fields));
}

Result<std::size_t> point_count(const std::filesystem::path& path, const PcdHeader& header) {
  if (!header.width && !header.points)
    return error_at(path, "the header has no POINTS and no WIDTH");
  if (!header.width) return *header.points;
  const std::size_t height = header.height.value_or(1);
  if (height != 0 && *header.width > (std::size_t{1} << 40) / height) {
    return error_at(path, "WIDTH {} x HEIGHT {} is not a number of points", *header.width, height);
  }
  const std::size_t count = *header.width * height;
  if (header.points && *header.points != count) {
    return error_at(path, "the header says POINTS {} but WIDTH {} x HEIGHT {}", *header.points,
                    *header.width, height);
  }
  return count;
}

Result<PointCloud> read_binary(const std::filesystem::path& path, const PointFields& fields,
                               std::string_view bytes, std::size_t count) {
  if (bytes.size() / fields.stride < count) {
    return error_at(path, "ends early: {} points of {} bytes expected, {} found", count,
                    fields.stride, bytes.size() / fields.stride);
  }
  return decode_rows(fields, bytes, count, false);
}

Result<PointCloud> read_compressed(const std::filesystem::path& path, const PointFields& fields,
                                   std::string_view bytes, std::size_t count) {
  files::ByteReader reader(bytes);
  const auto packed_size = reader.number<std::uint32_t>();
  const auto size = reader.number<std::uint32_t>();
  const auto packed = reader.bytes(packed_size);
  if (!reader.ok()) {
    return error_at(path, "ends early: {} compressed bytes expected, {} found", packed_size,
                    reader.left());
  }
  if (size / fields.stride != count || size % fields.stride != 0) {
    return error_at(path, "{} uncompressed bytes, expected {} points of {} bytes", size, count,
                    fields.stride);
  }
  std::string columns;
  if (!lzf_decompress(packed, size, columns)) {
    return error_at(path, "the compressed data is damaged: it does not unpack to {} bytes", size);
  }
  return decode_columns(fields, columns, count);
}

}  // namespace

Result<PointCloud> read_pcd(const std::filesystem::path& path, std::string_view bytes) {
  std::string_view rest = bytes;
  const auto header = parse_header(path, rest);
  if (!header) return header.error();
  const auto fields = header_fields(path, *header);
  if (!fields) return fields.error();
  const auto count = point_count(path, *header);
  if (!count) return count.error();
  if (header->data == "binary") return read_binary(path, *fields, rest, *count);
  if (header->data == "ascii") return decode_lines(path, *fields, rest, *count, header->lines + 1);
  if (header->data == "binary_compressed") return read_compressed(path, *fields, rest, *count);
  return error_at(path, "DATA is '{}', expected ascii, binary or binary_compressed", header->data);
}

std::string pcd_header(const PointCloud& cloud) {
  const bool far = !cloud.origin.isZero(0);
  const bool intensity = !cloud.intensity.empty();
  const int size = far ? 8 : 4;
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{}\n"
      "SIZE {} {} {}{}\nTYPE F F F{}\nCOUNT 1 1 1{}\nWIDTH {}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      intensity ? " intensity" : "", size, size, size, intensity ? " 4" : "", intensity ? " F" : "",
      intensity ? " 1" : "", cloud.points.size(), cloud.points.size());
}

}  // namespace holdfast::io::clouds
