#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "holdfast/core/result.hpp"

namespace holdfast::io::files {

/// A hidden name next to `path` (so on the same file system), for the `attempt`-th try of this
/// process to find one that is free.
std::filesystem::path staging_name(const std::filesystem::path& path, unsigned attempt);

/// A file that is written aside and takes its name on commit(); destroyed without commit() it
/// leaves nothing.
class StagedFile {
 public:
  static Result<StagedFile> create(const std::filesystem::path& path);
  StagedFile(StagedFile&& other) noexcept;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile();

  Status write(std::string_view bytes);
  /// Overwrites bytes that write() has already put at `position`.
  Status rewrite(std::uint64_t position, std::string_view bytes);
  Status commit();

  /// Bytes written so far.
  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  StagedFile(std::filesystem::path path, std::filesystem::path staging, int descriptor);
  Error failure(std::string_view what) const;
  Status write_at(std::uint64_t position, std::string_view bytes);

  std::filesystem::path path_;
  std::filesystem::path staging_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace holdfast::io::files
