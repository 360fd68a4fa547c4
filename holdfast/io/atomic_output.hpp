#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "holdfast/core/result.hpp"

namespace holdfast::io {

/// Writes `content` aside and renames it to `path`: a reader sees the old file, the new one, or
/// none.
Status write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// A folder that is filled aside and takes its name on commit(); destroyed without commit() it
/// leaves nothing. An existing folder of that name is replaced on commit() only if it is empty or
/// holds `marker` (a file that tells it is one of ours), so that no stranger's folder is deleted.
class AtomicFolder {
 public:
  static Result<AtomicFolder> create(const std::filesystem::path& path, std::string_view marker);
  AtomicFolder(AtomicFolder&& other) noexcept;
  AtomicFolder& operator=(AtomicFolder&&) = delete;
  ~AtomicFolder();

  /// Where to write until commit().
  const std::filesystem::path& staging() const { return staging_; }
  Status commit();

 private:
  AtomicFolder(std::filesystem::path path, std::filesystem::path staging, std::string marker);
  std::filesystem::path path_;
  std::filesystem::path staging_;
  std::string marker_;
};

}  // namespace holdfast::io
