#pragma once

#include <filesystem>
#include <string_view>

#include "holdfast/core/result.hpp"

namespace holdfast::io::files {

/// The bytes of a regular file, mapped read-only. They must not shrink while they are in use.
class MappedFile {
 public:
  static Result<MappedFile> open(const std::filesystem::path& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::string_view bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::string_view bytes) : bytes_(bytes) {}
  std::string_view bytes_;
};

}  // namespace holdfast::io::files
