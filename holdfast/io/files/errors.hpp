#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "holdfast/core/result.hpp"

namespace holdfast::io::files {

/// "<path>: <text>", the form of every message about a file.
template <class... Args>
Error error_at(const std::filesystem::path& path, fmt::format_string<Args...> text,
               Args&&... args) {
  return {path.string() + ": " + fmt::format(text, std::forward<Args>(args)...)};
}

}  // namespace holdfast::io::files
