#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "holdfast/core/result.hpp"

namespace holdfast::io::files {

/// A regular file open for reading at any place.
class InputFile {
 public:
  static Result<InputFile> open(const std::filesystem::path& path);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }
  int descriptor() const { return descriptor_; }

  /// Reads up to `size` bytes from `position`; fewer only at the end of the file or on an error.
  std::size_t read(std::uint64_t position, char* out, std::size_t size) const;

 private:
  InputFile(std::filesystem::path path, int descriptor, std::uint64_t size);
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// All bytes of a (small) file.
Result<std::string> read_text(const std::filesystem::path& path);

}  // namespace holdfast::io::files
