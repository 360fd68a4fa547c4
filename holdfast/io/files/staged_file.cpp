#include "holdfast/io/files/staged_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "holdfast/io/files/errors.hpp"

namespace holdfast::io::files {

std::filesystem::path staging_name(const std::filesystem::path& path, unsigned attempt) {
  const auto clean = path.has_filename() ? path : path.parent_path();
  return clean.parent_path() /
         fmt::format(".{}.partial-{}-{}", clean.filename().string(), ::getpid(), attempt);
}

StagedFile::StagedFile(std::filesystem::path path, std::filesystem::path staging, int descriptor)
    : path_(std::move(path)), staging_(std::move(staging)), descriptor_(descriptor) {}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : path_(std::move(other.path_)),
      staging_(std::move(other.staging_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

StagedFile::~StagedFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(staging_.c_str());
}

Error StagedFile::failure(std::string_view what) const {
  return error_at(path_, "{}: {}", what, std::strerror(errno));
}

Result<StagedFile> StagedFile::create(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return error_at(path, "is a folder, expected the name of a file to write");
  }
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  unsigned attempt = 0;
  int descriptor = -1;
  do {
    descriptor = ::open(staging_name(path, attempt++).c_str(), kFlags, 0666);
  } while (descriptor < 0 && errno == EEXIST);
  StagedFile file(path, staging_name(path, attempt - 1), descriptor);
  if (descriptor < 0) return file.failure("cannot be written");
  return file;
}

Status StagedFile::write_at(std::uint64_t position, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto put =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(position));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return failure("cannot be written");
    position += static_cast<std::uint64_t>(put);
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
  return Done{};
}

Status StagedFile::write(std::string_view bytes) {
  auto status = write_at(size_, bytes);
  if (status) size_ += bytes.size();
  return status;
}

Status StagedFile::rewrite(std::uint64_t position, std::string_view bytes) {
  return write_at(position, bytes);
}

Status StagedFile::commit() {
  // No fdatasync(): readers are safe without it, and it would cost seconds on a busy disk.
  if (::close(std::exchange(descriptor_, -1)) != 0 ||
      std::rename(staging_.c_str(), path_.c_str()) != 0) {
    Error error = failure("cannot be put in its place");
    ::unlink(staging_.c_str());
    return error;
  }
  return Done{};
}

}  // namespace holdfast::io::files
