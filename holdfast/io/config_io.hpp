#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "holdfast/core/fields.hpp"
#include "holdfast/core/result.hpp"

namespace YAML {
class Node;
}

/// Visitors over the field lists of configuration structs (holdfast/core/fields.hpp).
/// A configuration is a tree of at most two levels: top-level keys, and modules with keys.
namespace holdfast::io {

/// A value that a visitor can read and write, whatever its C++ type.
struct FieldRef {
  std::string key;   ///< "map_filter.range_sigma_m", or "T_body_lidar" at the top
  void* value;
  enum class Type { kBool, kInt, kDouble, kString, kDoubles, kPose } type;
  FieldDoc doc;
  bool* is_set = nullptr;  ///< for required keys: becomes true when the key was read
};

/// Collects the fields of a struct under `module` ("" for the top level).
template <class Config>
void collect_fields(const std::string& module, Config& config, std::vector<FieldRef>& out);

/// Reads a YAML file into the fields. Unknown keys are errors that name the nearest known key; wrong
/// types and values out of range name file, line, key, what was expected and found.
Status read_config_file(const std::filesystem::path& path, std::vector<FieldRef>& fields);

/// Applies one `module.key=value`.
Status set_field(const std::string& assignment, std::vector<FieldRef>& fields);

/// All fields as YAML text, each module a block, each key preceded by nothing: what read_config_file
/// reads back to the same values, bit for bit.
std::string write_config(const std::vector<FieldRef>& fields);

/// The reference page: one Markdown table a module with key, default, range or choices, meaning.
std::string config_reference(const std::vector<FieldRef>& fields);

}  // namespace holdfast::io

#include "holdfast/io/config_io_impl.hpp"
