#pragma once

#include <filesystem>
#include <string>

#include "holdfast/core/result.hpp"

namespace holdfast::evaluation {

/// The whole content of a file; the error names the file and the system's reason.
Result<std::string> read_text(const std::filesystem::path& path);

/// False also where the system does not let us look.
bool file_exists(const std::filesystem::path& path);

}  // namespace holdfast::evaluation
