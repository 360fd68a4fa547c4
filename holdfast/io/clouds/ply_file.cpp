#include "holdfast/io/clouds/ply_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "holdfast/io/clouds/point_fields.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/numbers.hpp"

namespace holdfast::io::clouds {
namespace {

using files::error_at;
using files::ScalarType;

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

/// A number, or a list of numbers behind its length.
struct PlyProperty {
  std::string_view name;
  ScalarType type = ScalarType::kFloat32;
  std::optional<ScalarType> length_type;
};

struct PlyElement {
  std::string_view name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;
};

std::optional<ScalarType> scalar_type(std::string_view name) {
  using Type = ScalarType;
  constexpr std::pair<std::string_view, Type> kTypes[] = {
      {"char", Type::kInt8},      {"int8", Type::kInt8},       {"uchar", Type::kUint8},
      {"uint8", Type::kUint8},    {"short", Type::kInt16},     {"int16", Type::kInt16},
      {"ushort", Type::kUint16},  {"uint16", Type::kUint16},   {"int", Type::kInt32},
      {"int32", Type::kInt32},    {"uint", Type::kUint32},     {"uint32", Type::kUint32},
      {"float", Type::kFloat32},  {"float32", Type::kFloat32}, {"double", Type::kFloat64},
      {"float64", Type::kFloat64}};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::optional<PlyFormat> parse_format(const std::vector<std::string_view>& words) {
  if (words.size() < 2) return std::nullopt;
  if (words[1] == "ascii") return PlyFormat::kAscii;
  if (words[1] == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (words[1] == "binary_big_endian") return PlyFormat::kBigEndian;
  return std::nullopt;
}

std::optional<PlyElement> parse_element(const std::vector<std::string_view>& words) {
  if (words.size() != 3) return std::nullopt;
  const auto count = files::parse_integer(words[2]);
  if (!count || *count < 0 || *count > (1LL << 40)) return std::nullopt;
  return PlyElement{words[1], static_cast<std::size_t>(*count), {}};
}

std::optional<PlyProperty> parse_property(const std::vector<std::string_view>& words) {
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (!is_list && words.size() != 3) return std::nullopt;
  const auto type = scalar_type(words[is_list ? 3 : 1]);
  const auto length_type = is_list ? scalar_type(words[2]) : std::nullopt;
  if (!type || (is_list && !length_type)) return std::nullopt;
  return PlyProperty{words.back(), *type, length_type};
}

/// Takes one header line behind the first; false if it is not one.
bool parse_header_line(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
  if (words[0] == "format") {
    const auto format = parse_format(words);
    if (format) header.format = *format;
    return format.has_value();
  }
  if (words[0] == "element") {
    auto element = parse_element(words);
    if (element) header.elements.push_back(std::move(*element));
    return element.has_value();
  }
  if (words[0] != "property" || header.elements.empty()) return false;
  const auto property = parse_property(words);
  if (property) header.elements.back().properties.push_back(*property);
  return property.has_value();
}

Result<PlyHeader> parse_header(const std::filesystem::path& path, std::string_view& rest) {
  PlyHeader header;
  std::string_view line;
  if (!files::take_line(rest, line) || line != "ply") {
    return error_at(path, "does not begin with 'ply'");
  }
  header.lines = 1;
  while (true) {
    if (!files::take_line(rest, line)) return error_at(path, "ends before 'end_header'");
    ++header.lines;
    const auto words = files::split_words(line);
    if (words.size() == 1 && words[0] == "end_header") return header;
    if (!parse_header_line(words, header)) {
      return error_at(path, "line {}: '{}' is not a line of a PLY header", header.lines,
                      line.substr(0, 80));
    }
  }
}

std::size_t load_length(ScalarType type, const char* at, bool swap) {
  char bytes[8];
  const std::size_t size = files::size_of(type);
  std::copy(at, at + size, bytes);
  if (swap) std::reverse(bytes, bytes + size);
  const double value = files::load_as_double(type, bytes);
  return value > 0 ? static_cast<std::size_t>(std::min(value, 1e12)) : 0;
}

/// Passes over one binary property; false if the bytes end in it.
bool skip_property(const PlyProperty& property, bool swap, std::string_view& rest) {
  std::size_t size = files::size_of(property.type);
  if (property.length_type) {
    const std::size_t length_size = files::size_of(*property.length_type);
    if (rest.size() < length_size) return false;
    size *= load_length(*property.length_type, rest.data(), swap);
    rest.remove_prefix(length_size);
  }
  if (rest.size() < size) return false;
  rest.remove_prefix(size);
  return true;
}

/// Passes over an element that stands before the vertices; false if the bytes end in it.
bool skip_element(const PlyElement& element, PlyHeader& header, std::string_view& rest) {
  if (element.properties.empty()) return true;
  for (std::size_t i = 0; i < element.count; ++i) {
    if (header.format == PlyFormat::kAscii) {
      std::string_view line;
      if (!files::take_line(rest, line)) return false;
      ++header.lines;
      continue;
    }
    for (const auto& property : element.properties) {
      if (!skip_property(property, header.format == PlyFormat::kBigEndian, rest)) return false;
    }
  }
  return true;
}

Result<PointFields> vertex_fields(const std::filesystem::path& path, const PlyElement& vertex) {
  std::vector<PointField> fields;
  for (const auto& property : vertex.properties) {
    if (property.length_type) {
      return error_at(path, "property '{}' of the vertices is a list, expected numbers",
                      property.name);
    }
    PointField field;
    field.name = property.name;
    field.type = property.type;
    fields.push_back(std::move(field));
  }
  return arrange_fields(path, std::move(fields));
}

Result<PointCloud> read_vertices(const std::filesystem::path& path, const PlyHeader& header,
                                 const PlyElement& vertex, std::string_view rest) {
  const auto fields = vertex_fields(path, vertex);
  if (!fields) return fields.error();
  if (header.format == PlyFormat::kAscii) {
    return decode_lines(path, *fields, rest, vertex.count, header.lines + 1);
  }
  if (rest.size() / fields->stride < vertex.count) {
    return error_at(path, "ends early: {} vertices of {} bytes expected, {} found", vertex.count,
                    fields->stride, rest.size() / fields->stride);
  }
  return decode_rows(*fields, rest, vertex.count, header.format == PlyFormat::kBigEndian);
}

}  // namespace

Result<PointCloud> read_ply(const std::filesystem::path& path, std::string_view bytes) {
  std::string_view rest = bytes;
  auto header = parse_header(path, rest);
  if (!header) return header.error();
  for (const auto& element : header->elements) {
    if (element.name == "vertex") return read_vertices(path, *header, element, rest);
    if (!skip_element(element, *header, rest)) {
      return error_at(path, "ends early: in element '{}', before the vertices", element.name);
    }
  }
  return error_at(path, "has no element 'vertex'");
}

std::string ply_header(const PointCloud& cloud) {
  const std::string_view type = cloud.origin.isZero(0) ? "float" : "double";
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty {} x\nproperty {} y\n"
      "property {} z\n{}end_header\n",
      cloud.points.size(), type, type, type,
      cloud.intensity.empty() ? "" : "property float intensity\n");
}

}  // namespace holdfast::io::clouds
