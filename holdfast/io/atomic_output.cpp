#include "holdfast/io/atomic_output.hpp"

#include <utility>

#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/staged_file.hpp"

namespace holdfast::io {
namespace {

namespace fs = std::filesystem;
using files::error_at;

/// Whether a folder may take the name `path`: it is free, an empty folder, or a folder of ours.
Status check_replaceable(const fs::path& path, const std::string& marker) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) return Done{};
  if (error) return error_at(path, "cannot be examined: {}", error.message());
  if (status.type() != fs::file_type::directory) {
    return error_at(path, "exists and is not a folder, expected a new folder's name");
  }
  const bool empty = fs::is_empty(path, error);
  if (error) return error_at(path, "cannot be examined: {}", error.message());
  if (empty || fs::exists(path / marker, error)) return Done{};
  return error_at(path, "is a folder with other content (it holds no {}) and is not replaced",
                  marker);
}

fs::path without_trailing_separator(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

Status write_file_atomically(const fs::path& path, std::string_view content) {
  auto file = files::StagedFile::create(path);
  if (!file) return file.error();
  auto written = file->write(content);
  if (!written) return written;
  return file->commit();
}

AtomicFolder::AtomicFolder(fs::path path, fs::path staging, std::string marker)
    : path_(std::move(path)), staging_(std::move(staging)), marker_(std::move(marker)) {}

AtomicFolder::AtomicFolder(AtomicFolder&& other) noexcept
    : path_(std::move(other.path_)),
      staging_(std::exchange(other.staging_, fs::path{})),
      marker_(std::move(other.marker_)) {}

AtomicFolder::~AtomicFolder() {
  if (staging_.empty()) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

Result<AtomicFolder> AtomicFolder::create(const fs::path& path, std::string_view marker) {
  const auto target = without_trailing_separator(path);
  const auto replaceable = check_replaceable(target, std::string(marker));
  if (!replaceable) return replaceable.error();
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  unsigned attempt = 0;
  // create_directory() is false without an error where the name is taken.
  while (!error && !fs::create_directory(files::staging_name(target, attempt), error)) ++attempt;
  if (error) return error_at(path, "cannot be made: {}", error.message());
  return AtomicFolder(target, files::staging_name(target, attempt), std::string(marker));
}

Status AtomicFolder::commit() {
  std::error_code error;
  if (!fs::exists(staging_ / marker_, error)) {
    return error_at(path_, "is not complete: {} was not written", marker_);
  }
  auto replaceable = check_replaceable(path_, marker_);
  if (!replaceable) return replaceable;
  // rename() does not replace a folder with content: the old one steps aside first.
  unsigned attempt = 0;
  while (fs::exists(files::staging_name(path_, attempt), error)) ++attempt;
  const auto old = files::staging_name(path_, attempt);
  fs::rename(path_, old, error);
  const bool had_old = !error;
  fs::rename(staging_, path_, error);
  if (error) {
    std::error_code ignored;
    if (had_old) fs::rename(old, path_, ignored);
    return error_at(path_, "cannot be put in its place: {}", error.message());
  }
  staging_.clear();
  if (had_old) fs::remove_all(old, error);
  return Done{};
}

}  // namespace holdfast::io
