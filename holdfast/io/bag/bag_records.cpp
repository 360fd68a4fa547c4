#include "holdfast/io/bag/bag_records.hpp"

namespace holdfast::io::bag {

std::optional<std::string_view> Fields::find(std::string_view name) const {
  files::ByteReader reader(bytes_);
  while (reader.left() > 0) {
    const std::string_view field = reader.counted();
    if (!reader.ok()) return std::nullopt;
    if (field.size() > name.size() && field[name.size()] == '=' &&
        field.substr(0, name.size()) == name) {
      return field.substr(name.size() + 1);
    }
  }
  return std::nullopt;
}

std::optional<Op> Fields::op() const {
  const auto value = number<std::uint8_t>("op");
  if (!value || *value < static_cast<std::uint8_t>(Op::kMessage) ||
      *value > static_cast<std::uint8_t>(Op::kConnection)) {
    return std::nullopt;
  }
  return static_cast<Op>(*value);
}

std::optional<TimeNs> Fields::time(std::string_view name) const {
  const auto value = number<std::uint64_t>(name);
  if (!value) return std::nullopt;
  const auto seconds = static_cast<TimeNs>(*value & 0xffffffffU);
  const auto nanoseconds = static_cast<TimeNs>(*value >> 32);
  return seconds * kSecond + nanoseconds;
}

std::optional<Record> take_record(files::ByteReader& reader) {
  Record record;
  record.header = Fields(reader.counted());
  record.data = reader.counted();
  if (!reader.ok()) return std::nullopt;
  return record;
}

void append_field(std::string& out, std::string_view name, std::string_view value) {
  files::append(out, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  out.append(name).append("=").append(value);
}

void append_op(std::string& out, Op op) {
  append_number_field(out, "op", static_cast<std::uint8_t>(op));
}

void append_time(std::string& out, TimeNs t) {
  files::append(out, static_cast<std::uint32_t>(t / kSecond));
  files::append(out, static_cast<std::uint32_t>(t % kSecond));
}

}  // namespace holdfast::io::bag
