#include "holdfast/io/clouds/point_fields.hpp"

#include <algorithm>
#include <array>

#include "holdfast/io/clouds/cloud_builder.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/numbers.hpp"

namespace holdfast::io::clouds {
namespace {

using files::error_at;
using files::ScalarType;

std::string list_names(const std::vector<PointField>& fields) {
  std::string names;
  for (const auto& field : fields) {
    if (!names.empty()) names += ", ";
    names += field.name;
  }
  return names.empty() ? "none" : names;
}

std::optional<std::size_t> find_field(const std::vector<PointField>& fields,
                                      std::string_view name) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].name == name) return i;
  }
  return std::nullopt;
}

Result<std::size_t> find_coordinate(const std::filesystem::path& path,
                                    const std::vector<PointField>& fields, std::string_view name) {
  const auto index = find_field(fields, name);
  if (!index) {
    return error_at(path, "has no field '{}'; its fields are {}", name, list_names(fields));
  }
  const auto& field = fields[*index];
  if (!files::is_floating(field.type) || field.count != 1) {
    return error_at(path, "field '{}' is {} x {}, expected one float32 or float64", name,
                    field.count, files::name_of(field.type));
  }
  return *index;
}

std::optional<std::size_t> find_intensity(const std::vector<PointField>& fields) {
  for (const auto name : {"intensity", "scalar_intensity", "scalar_Intensity", "reflectance"}) {
    const auto index = find_field(fields, name);
    if (index && fields[*index].count == 1) return index;
  }
  return std::nullopt;
}

template <class T>
T load_number(const char* at, bool swap) {
  if (!swap) return files::load<T>(at);
  std::array<char, sizeof(T)> bytes;
  std::reverse_copy(at, at + sizeof(T), bytes.begin());
  return files::load<T>(bytes.data());
}

float load_intensity(ScalarType type, const char* at, bool swap) {
  return files::visit_scalar(type, [at, swap](auto zero) {
    return static_cast<float>(load_number<decltype(zero)>(at, swap));
  });
}

/// Where the numbers of point i stand: start[field] + i * step[field].
struct Placement {
  std::array<const char*, 4> start{};  // x, y, z, intensity
  std::array<std::size_t, 4> step{};
};

template <class T>
void add_points(const PointFields& fields, const Placement& place, std::size_t count, bool swap,
                CloudBuilder& builder) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t field) { return place.start[field] + i * place.step[field]; };
    const float intensity =
        fields.intensity ? load_intensity(fields.all[*fields.intensity].type, at(3), swap) : 0.0F;
    builder.add(load_number<T>(at(0), swap), load_number<T>(at(1), swap),
                load_number<T>(at(2), swap), intensity);
  }
}

PointCloud decode(const PointFields& fields, const Placement& place, std::size_t count, bool swap) {
  CloudBuilder builder(fields.is_double(), fields.intensity.has_value(), count);
  if (fields.is_double())
    add_points<double>(fields, place, count, swap, builder);
  else
    add_points<float>(fields, place, count, swap, builder);
  return builder.finish();
}

/// x, y, z and intensity (0 if there is none) from one line of text.
Result<std::array<double, 4>> parse_point(const PointFields& fields, std::string_view text) {
  constexpr std::size_t kUnused = static_cast<std::size_t>(-1);
  const auto column_of = [&fields](std::size_t i) { return fields.all[i].column; };
  const std::array<std::size_t, 4> used = {
      column_of(fields.x), column_of(fields.y), column_of(fields.z),
      fields.intensity ? column_of(*fields.intensity) : kUnused};
  std::array<double, 4> values{};
  for (std::size_t column = 0; column < fields.columns; ++column) {
    const auto word = files::take_word(text);
    if (word.empty()) {
      return Error{fmt::format("{} values, expected {}", column, fields.columns)};
    }
    const auto slot = std::find(used.begin(), used.end(), column);
    if (slot == used.end()) continue;
    const auto value = files::parse_double(word);
    if (!value) return Error{fmt::format("'{}' is not a number", word)};
    values[static_cast<std::size_t>(slot - used.begin())] = *value;
  }
  return values;
}

}  // namespace

bool PointFields::is_double() const { return all[x].type == ScalarType::kFloat64; }

Result<PointFields> arrange_fields(const std::filesystem::path& path,
                                   std::vector<PointField> fields) {
  PointFields out;
  for (auto& field : fields) {
    field.offset = out.stride;
    field.column = out.columns;
    out.stride += field.count * files::size_of(field.type);
    out.columns += field.count;
  }
  std::array<std::size_t*, 3> targets = {&out.x, &out.y, &out.z};
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = find_coordinate(path, fields, kNames[axis]);
    if (!index) return index.error();
    *targets[axis] = *index;
    if (fields[*index].type != fields[out.x].type) {
      return error_at(path, "field '{}' is {} but 'x' is {}, expected one type for all three",
                      kNames[axis], files::name_of(fields[*index].type),
                      files::name_of(fields[out.x].type));
    }
  }
  out.intensity = find_intensity(fields);
  out.all = std::move(fields);
  return out;
}

PointCloud decode_rows(const PointFields& fields, std::string_view bytes, std::size_t count,
                       bool swap) {
  Placement place;
  place.step.fill(fields.stride);
  const std::array<std::size_t, 4> used = {fields.x, fields.y, fields.z,
                                           fields.intensity.value_or(fields.x)};
  for (std::size_t i = 0; i < used.size(); ++i) {
    place.start[i] = bytes.data() + fields.all[used[i]].offset;
  }
  return decode(fields, place, count, swap);
}

PointCloud decode_columns(const PointFields& fields, std::string_view bytes, std::size_t count) {
  Placement place;
  const std::array<std::size_t, 4> used = {fields.x, fields.y, fields.z,
                                           fields.intensity.value_or(fields.x)};
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& field = fields.all[used[i]];
    place.start[i] = bytes.data() + field.offset * count;
    place.step[i] = field.count * files::size_of(field.type);
  }
  return decode(fields, place, count, false);
}

Result<PointCloud> decode_lines(const std::filesystem::path& path, const PointFields& fields,
                                std::string_view& rest, std::size_t count, std::size_t line) {
  const std::size_t shortest_line = 2 * fields.columns;
  CloudBuilder builder(true, fields.intensity.has_value(),
                       std::min(count, rest.size() / shortest_line + 1));
  for (std::size_t point = 0; point < count; ++line) {
    std::string_view text;
    if (!files::take_line(rest, text)) {
      return error_at(path, "ends after {} of {} points", point, count);
    }
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const auto values = parse_point(fields, text);
    if (!values) return error_at(path, "line {}: {}", line, values.error().message);
    const auto& [x, y, z, intensity] = *values;
    builder.add(x, y, z, static_cast<float>(intensity));
    ++point;
  }
  return builder.finish();
}

}  // namespace holdfast::io::clouds
