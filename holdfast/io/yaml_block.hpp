#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/config_io.hpp"

/// For documents that are more than a configuration: lists of blocks, each with fields of its own.
namespace holdfast::io {

/// The one document of a file. Errors name file and line.
Result<YAML::Node> load_yaml(const std::filesystem::path& path);
/// Likewise of a text that is called `name`.
Result<YAML::Node> parse_yaml(const std::string& text, const std::string& name);

/// Reads a block of a document of `file` into the fields, as read_config_file reads a whole one.
Status read_block(const YAML::Node& block, const std::string& file, std::vector<FieldRef>& fields);

/// What stands there, in a few words for a message.
std::string describe_node(const YAML::Node& node);

}  // namespace holdfast::io
