// The two ways out: YAML that reads back bit for bit, and the reference page.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "holdfast/io/config_io.hpp"

namespace holdfast::io {
namespace {

using Type = FieldRef::Type;

template <class T>
const T& get(const FieldRef& field) {
  return *static_cast<const T*>(field.value);
}

/// Double-quoted YAML; every byte below space is escaped, UTF-8 stands as it is.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// Words that no YAML reader takes for anything but text stand without quotes.
std::string text_value(const std::string& text) {
  constexpr std::array<std::string_view, 7> kReserved = {"null", "true", "false", "yes",
                                                         "no",   "on",   "off"};
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
  };
  const bool starts_plain = !text.empty() && (text[0] == '/' || (text[0] >= 'a' && text[0] <= 'z'));
  const bool plain = starts_plain && std::all_of(text.begin(), text.end(), is_plain) &&
                     std::find(kReserved.begin(), kReserved.end(), text) == kReserved.end();
  return plain ? text : quoted(text);
}

std::string pose_value(const SE3& pose) {
  const auto& q = pose.rotation;
  const auto& p = pose.translation;
  return fmt::format("[{}, {}, {}, {}, {}, {}, {}]", p.x(), p.y(), p.z(), q.x(), q.y(), q.z(),
                     q.w());
}

template <class Vector>
std::string list_value(const Vector& v) {
  return fmt::format("[{}]", fmt::join(v.begin(), v.end(), ", "));
}

std::string value_text(const FieldRef& field) {
  switch (field.type) {
    case Type::kBool: return get<bool>(field) ? "true" : "false";
    case Type::kInt: return fmt::format("{}", get<int>(field));
    case Type::kDouble: return fmt::format("{}", get<double>(field));
    case Type::kString: return text_value(get<std::string>(field));
    case Type::kDoubles:
      return fmt::format("[{}]", fmt::join(get<std::vector<double>>(field), ", "));
    case Type::kVector2: return list_value(get<Eigen::Vector2d>(field));
    case Type::kVector3: return list_value(get<Eigen::Vector3d>(field));
    case Type::kPose: return pose_value(get<SE3>(field));
  }
  return {};
}

bool is_unset(const FieldRef& field) { return field.is_set != nullptr && !*field.is_set; }

std::string_view type_name(Type type) {
  switch (type) {
    case Type::kBool: return "true or false";
    case Type::kInt: return "whole number";
    case Type::kDouble: return "number";
    case Type::kString: return "text";
    case Type::kDoubles: return "list of numbers";
    case Type::kVector2: return "two numbers";
    case Type::kVector3: return "three numbers";
    case Type::kPose: return "pose";
  }
  return {};
}

std::string module_of(const FieldRef& field) {
  const auto dot = field.key.find('.');
  return dot == std::string::npos ? "" : field.key.substr(0, dot);
}

std::string leaf_of(const FieldRef& field) {
  const auto dot = field.key.find('.');
  return dot == std::string::npos ? field.key : field.key.substr(dot + 1);
}

using Module = std::pair<std::string, std::vector<const FieldRef*>>;

/// Modules in the order in which they first appear, the top level before all.
std::vector<Module> by_module(const std::vector<FieldRef>& fields) {
  std::vector<Module> modules = {{"", {}}};
  for (const auto& field : fields) {
    const std::string name = module_of(field);
    auto found = std::find_if(modules.begin(), modules.end(),
                              [&](const Module& module) { return module.first == name; });
    if (found == modules.end()) found = modules.insert(found, {name, {}});
    found->second.push_back(&field);
  }
  if (modules.front().second.empty()) modules.erase(modules.begin());
  return modules;
}

std::string allowed_text(const FieldRef& field) {
  const auto& doc = field.doc;
  if (!doc.choices.empty()) return std::string(doc.choices);
  if (field.type == Type::kPose) return "x, y, z, qx, qy, qz, qw";
  const bool has_min = std::isfinite(doc.min);
  const bool has_max = std::isfinite(doc.max);
  if (has_min && has_max) return fmt::format("{} to {}", doc.min, doc.max);
  if (has_min) return fmt::format(">= {}", doc.min);
  if (has_max) return fmt::format("<= {}", doc.max);
  return "";
}

std::string table_cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string write_config(const std::vector<FieldRef>& fields) {
  std::string out;
  for (const auto& [module, members] : by_module(fields)) {
    if (!module.empty()) out += fmt::format("{}:\n", module);
    const std::string_view indent = module.empty() ? "" : "  ";
    for (const FieldRef* field : members) {
      if (is_unset(*field)) {
        out += fmt::format("{}# {}: required, without a default\n", indent, leaf_of(*field));
      } else {
        out += fmt::format("{}{}: {}\n", indent, leaf_of(*field), value_text(*field));
      }
    }
  }
  return out;
}

std::string config_reference(const std::vector<FieldRef>& fields) {
  std::string out;
  for (const auto& [module, members] : by_module(fields)) {
    out +=
        fmt::format("{}## {}\n\n", out.empty() ? "" : "\n", module.empty() ? "top level" : module);
    out += "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n";
    for (const FieldRef* field : members) {
      const std::string fallback =
          is_unset(*field) ? "required" : fmt::format("`{}`", table_cell(value_text(*field)));
      out += fmt::format("| `{}` | {} | {} | {} | {} |\n", leaf_of(*field), type_name(field->type),
                         fallback, table_cell(allowed_text(*field)), table_cell(field->doc.text));
    }
  }
  return out;
}

}  // namespace holdfast::io
