#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/files/scalar_type.hpp"
#include "holdfast/io/point_cloud.hpp"

namespace holdfast::io::clouds {

/// One number (or `count` numbers) of every point of a file.
struct PointField {
  std::string name;
  files::ScalarType type = files::ScalarType::kFloat32;
  std::size_t count = 1;
  std::size_t offset = 0;  ///< bytes from the start of a point
  std::size_t column = 0;  ///< words from the start of a line
};

/// The fields of a file's points, and which of them are used.
struct PointFields {
  std::vector<PointField> all;
  std::size_t x = 0, y = 0, z = 0;  ///< indices into `all`
  std::optional<std::size_t> intensity;
  std::size_t stride = 0;   ///< bytes a point
  std::size_t columns = 0;  ///< words a line

  /// Whether the coordinates have more digits than a float.
  bool is_double() const;
};

/// Places the fields one after the other and finds x, y, z and intensity among them.
Result<PointFields> arrange_fields(const std::filesystem::path& path,
                                   std::vector<PointField> fields);

/// Points stored one after the other in binary, `count` of `fields.stride` bytes; with `swap` in
/// big endian. `bytes` must hold them all.
PointCloud decode_rows(const PointFields& fields, std::string_view bytes, std::size_t count,
                       bool swap);

/// Points stored field after field (the layout inside binary_compressed). `bytes` must hold them
/// all.
PointCloud decode_columns(const PointFields& fields, std::string_view bytes, std::size_t count);

/// Points as lines of text; the first line is line `line` of the file. `rest` is left behind the
/// last.
Result<PointCloud> decode_lines(const std::filesystem::path& path, const PointFields& fields,
                                std::string_view& rest, std::size_t count, std::size_t line);

}  // namespace holdfast::io::clouds
