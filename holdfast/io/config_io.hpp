#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/result.hpp"

/// Visitors over the field lists of configuration structs (holdfast/core/fields.hpp).
/// A configuration is a tree of at most two levels: top-level keys, and modules with keys.
/// No function here keeps state; all are safe to call from several threads on different fields.
namespace holdfast::io {

/// A value that a visitor can read and write, whatever its C++ type.
struct FieldRef {
  std::string key;  ///< "map_filter.range_sigma_m", or "T_body_lidar" at the top
  void* value;
  enum class Type { kBool, kInt, kDouble, kString, kDoubles, kVector2, kVector3, kPose } type;
  FieldDoc doc;
  bool* is_set = nullptr;  ///< for required keys: becomes true when the key was read
};

/// Collects the fields of a struct under `module` ("" for the top level). The struct must outlive
/// the references.
template <class Config>
void collect_fields(const std::string& module, Config& config, std::vector<FieldRef>& out);

/// Reads a YAML file into the fields; keys that the file does not hold keep their values. Unknown
/// keys are errors that name the nearest known key; wrong types and values out of range name file,
/// line, key, what was expected and found. After an error no field has changed.
Status read_config_file(const std::filesystem::path& path, std::vector<FieldRef>& fields);

/// Applies one `module.key=value`; text is taken as it stands, lists and poses as "[1, 2, 3]".
Status set_field(const std::string& assignment, std::vector<FieldRef>& fields);

/// An Error that names every required key (is_set given) which nothing has set; `place` is the file
/// or command that should have held it.
Status check_required(const std::string& place, const std::vector<FieldRef>& fields);

/// All fields as YAML text, each module a block: what read_config_file reads back to the same
/// values, bit for bit. A required key that is not set stands as a comment, since it has no
/// default.
std::string write_config(const std::vector<FieldRef>& fields);

/// The reference page: one Markdown table a module with key, type, default, range or choices,
/// meaning.
std::string config_reference(const std::vector<FieldRef>& fields);

template <class T>
constexpr FieldRef::Type field_type() {
  using Type = FieldRef::Type;
  if constexpr (std::is_same_v<T, bool>)
    return Type::kBool;
  else if constexpr (std::is_same_v<T, int>)
    return Type::kInt;
  else if constexpr (std::is_same_v<T, double>)
    return Type::kDouble;
  else if constexpr (std::is_same_v<T, std::string>)
    return Type::kString;
  else if constexpr (std::is_same_v<T, std::vector<double>>)
    return Type::kDoubles;
  else if constexpr (std::is_same_v<T, Eigen::Vector2d>)
    return Type::kVector2;
  else if constexpr (std::is_same_v<T, Eigen::Vector3d>)
    return Type::kVector3;
  else {
    static_assert(std::is_same_v<T, SE3>, "not a type that a configuration field may have");
    return Type::kPose;
  }
}

template <class Config>
void collect_fields(const std::string& module, Config& config, std::vector<FieldRef>& out) {
  const auto visit = [&](const char* key, auto& value, const FieldDoc& doc,
                         bool* is_set = nullptr) {
    using T = std::remove_reference_t<decltype(value)>;
    out.push_back(
        {module.empty() ? key : module + "." + key, &value, field_type<T>(), doc, is_set});
  };
  Config::fields(config, visit);
}

}  // namespace holdfast::io
