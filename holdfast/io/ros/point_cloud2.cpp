#include "holdfast/io/ros/point_cloud2.hpp"

#include <fmt/format.h>

#include <vector>

#include "holdfast/io/files/bytes.hpp"
#include "holdfast/io/ros/imu_message.hpp"

namespace holdfast::io::ros {
namespace {

using files::ScalarType;

/// A PointField as it stands in the message.
struct RawField {
  std::string_view name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};

RawField read_field(files::ByteReader& reader) {
  RawField field;
  field.name = reader.counted();
  field.offset = reader.number<std::uint32_t>();
  field.datatype = reader.number<std::uint8_t>();
  field.count = reader.number<std::uint32_t>();
  return field;
}

/// Passes over an array of PointField and returns its bytes.
std::string_view take_fields(files::ByteReader& reader) {
  const char* begin = reader.at();
  const auto count = reader.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && reader.ok(); ++i) read_field(reader);
  return reader.ok() ? std::string_view(begin, static_cast<std::size_t>(reader.at() - begin))
                     : std::string_view{};
}

std::vector<RawField> read_fields(std::string_view bytes) {
  files::ByteReader reader(bytes);
  const auto count = reader.number<std::uint32_t>();
  std::vector<RawField> fields;
  for (std::uint32_t i = 0; i < count && reader.ok(); ++i) fields.push_back(read_field(reader));
  return fields;
}

/// Codes 1 to 8 of PointField stand for int8 to uint32, float32, float64.
std::optional<ScalarType> scalar_type(const RawField& field) {
  constexpr ScalarType kTypes[] = {ScalarType::kInt8,    ScalarType::kUint8,  ScalarType::kInt16,
                                   ScalarType::kUint16,  ScalarType::kInt32,  ScalarType::kUint32,
                                   ScalarType::kFloat32, ScalarType::kFloat64};
  if (field.datatype < 1 || field.datatype > std::size(kTypes)) return std::nullopt;
  return kTypes[field.datatype - 1];
}

/// 64-bit integers have no code of their own and travel as two uint32 or eight uint8.
bool is_wide_integer(ScalarType type, std::uint32_t count) {
  return (type == ScalarType::kUint32 && count == 2) || (type == ScalarType::kUint8 && count == 8);
}

std::string describe(const RawField& field) {
  const auto type = scalar_type(field);
  const auto name =
      type ? std::string(files::name_of(*type)) : fmt::format("type code {}", field.datatype);
  return field.count > 1 ? fmt::format("{} x {}", field.count, name) : name;
}

enum class Kind { kCoordinate, kNumber, kInteger, kTime };

Result<FieldPlace> place_field(const RawField& field, Kind kind, std::uint32_t point_step) {
  const char* expected = kind == Kind::kCoordinate ? "one float32 or float64"
                         : kind == Kind::kInteger  ? "one integer"
                                                   : "one number";
  auto type = scalar_type(field);
  // Some drivers leave the count of a single value at 0.
  bool good = type && field.count <= 1;
  if (type && kind == Kind::kTime && is_wide_integer(*type, field.count)) {
    type = ScalarType::kUint64;
    good = true;
  }
  if (good && kind == Kind::kCoordinate) good = files::is_floating(*type);
  if (good && kind == Kind::kInteger) good = !files::is_floating(*type);
  if (!good) {
    return Error{
        fmt::format("field '{}' is {}, expected {}", field.name, describe(field), expected)};
  }
  if (std::uint64_t{field.offset} + files::size_of(*type) > point_step) {
    return Error{fmt::format("field '{}' at byte {} lies outside a point of {} bytes", field.name,
                             field.offset, point_step)};
  }
  return FieldPlace{std::string(field.name), field.offset, *type};
}

/// The first of `names` that the points have; an empty place if they have none.
Result<FieldPlace> find_field(const std::vector<RawField>& fields,
                              const std::vector<std::string_view>& names, Kind kind,
                              std::uint32_t point_step) {
  for (const auto name : names) {
    for (const auto& field : fields) {
      if (field.name == name) return place_field(field, kind, point_step);
    }
  }
  return FieldPlace{};
}

std::string list_names(const std::vector<RawField>& fields) {
  std::string names;
  for (const auto& field : fields) {
    if (!names.empty()) names += ", ";
    names += field.name;
  }
  return names.empty() ? "none" : names;
}

/// Whether the data holds all points. One row needs no row_step.
bool data_holds_points(CloudMessage& message) {
  if (message.points() == 0) return true;
  if (message.point_step == 0) return false;
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  if (row > message.data.size()) return false;
  if (message.height == 1) return true;
  return message.row_step >= row &&
         message.height - 1 <= (message.data.size() - row) / message.row_step;
}

void append_point_field(std::string& out, std::string_view name, std::uint32_t offset,
                        std::uint8_t datatype) {
  files::append_counted(out, name);
  files::append(out, offset);
  files::append(out, datatype);
  files::append(out, std::uint32_t{1});
}

}  // namespace

std::optional<TimeNs> parse_stamp(std::string_view message) {
  files::ByteReader reader(message);
  return read_header_stamp(reader);
}

std::optional<CloudMessage> parse_cloud(std::string_view message) {
  files::ByteReader reader(message);
  const auto stamp = read_header_stamp(reader);
  if (!stamp) return std::nullopt;
  CloudMessage cloud;
  cloud.stamp = *stamp;
  cloud.height = reader.number<std::uint32_t>();
  cloud.width = reader.number<std::uint32_t>();
  cloud.fields = take_fields(reader);
  cloud.big_endian = reader.number<std::uint8_t>() != 0;
  cloud.point_step = reader.number<std::uint32_t>();
  cloud.row_step = reader.number<std::uint32_t>();
  cloud.data = reader.counted();
  reader.number<std::uint8_t>();  // is_dense: drivers set it carelessly, so points are checked
  if (!reader.ok() || !data_holds_points(cloud)) return std::nullopt;
  return cloud;
}

Result<CloudLayout> find_layout(const CloudMessage& message) {
  const auto fields = read_fields(message.fields);
  CloudLayout layout;
  struct Wanted {
    FieldPlace& place;
    std::vector<std::string_view> names;
    Kind kind;
  };
  const Wanted all[] = {
      {layout.x, {"x"}, Kind::kCoordinate},
      {layout.y, {"y"}, Kind::kCoordinate},
      {layout.z, {"z"}, Kind::kCoordinate},
      {layout.intensity, {"intensity"}, Kind::kNumber},
      {layout.ring, {"ring", "channel", "line"}, Kind::kInteger},
      {layout.time, {"time", "t", "timestamp", "time_offset", "offset_time"}, Kind::kTime}};
  for (const auto& wanted : all) {
    auto place = find_field(fields, wanted.names, wanted.kind, message.point_step);
    if (!place) return place.error();
    if (!*place && wanted.kind == Kind::kCoordinate) {
      return Error{fmt::format("the points have no field '{}'; their fields are {}",
                               wanted.names[0], list_names(fields))};
    }
    wanted.place = std::move(*place);
  }
  if (layout.x.type != layout.y.type || layout.x.type != layout.z.type) {
    return Error{fmt::format("fields x, y, z are {}, {}, {}, expected one type",
                             files::name_of(layout.x.type), files::name_of(layout.y.type),
                             files::name_of(layout.z.type))};
  }
  return layout;
}

std::string serialise_cloud(const Scan& scan, std::uint32_t sequence, std::string_view frame) {
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::uint8_t kUint16 = 4;
  const auto count = static_cast<std::uint32_t>(scan.points.size());
  const std::uint32_t ring_at = 16;
  const std::uint32_t time_at = scan.has_ring ? 18 : 16;
  const std::uint32_t step = time_at + (scan.has_point_times ? 4 : 0);
  std::string out;
  out.reserve(256 + std::size_t{count} * step);
  append_header(out, sequence, scan.stamp, frame);
  files::append(out, std::uint32_t{1});  // height
  files::append(out, count);
  files::append(out, 4U + scan.has_ring + scan.has_point_times);
  append_point_field(out, "x", 0, kFloat32);
  append_point_field(out, "y", 4, kFloat32);
  append_point_field(out, "z", 8, kFloat32);
  append_point_field(out, "intensity", 12, kFloat32);
  if (scan.has_ring) append_point_field(out, "ring", ring_at, kUint16);
  if (scan.has_point_times) append_point_field(out, "time", time_at, kFloat32);
  files::append(out, std::uint8_t{0});  // little endian
  files::append(out, step);
  files::append(out, count * step);
  files::append(out, count * step);  // length of data
  for (const auto& p : scan.points) {
    for (const float value : {p.x, p.y, p.z, p.intensity}) files::append(out, value);
    if (scan.has_ring) files::append(out, p.ring);
    if (scan.has_point_times) files::append(out, static_cast<float>(p.time_offset_ns * 1e-9));
  }
  files::append(out, std::uint8_t{1});  // dense: no point is invalid
  return out;
}

}  // namespace holdfast::io::ros
