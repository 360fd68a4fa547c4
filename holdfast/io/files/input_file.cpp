#include "holdfast/io/files/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "holdfast/io/files/errors.hpp"

namespace holdfast::io::files {

InputFile::InputFile(std::filesystem::path path, int descriptor, std::uint64_t size)
    : path_(std::move(path)), descriptor_(descriptor), size_(size) {}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  // Without O_NONBLOCK a named pipe would block here for ever.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return error_at(path, "cannot be opened: {}", std::strerror(errno));
  struct stat info {};
  if (::fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) {
    ::close(descriptor);
    return error_at(path, "is not a regular file");
  }
  return InputFile(path, descriptor, static_cast<std::uint64_t>(info.st_size));
}

std::size_t InputFile::read(std::uint64_t position, char* out, std::size_t size) const {
  std::size_t done = 0;
  while (done < size) {
    const auto got =
        ::pread(descriptor_, out + done, size - done, static_cast<off_t>(position + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

Result<std::string> read_text(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  if (!file) return file.error();
  std::string text(file->size(), '\0');
  if (file->read(0, text.data(), text.size()) != text.size()) {
    return error_at(path, "cannot be read to its end: {}", std::strerror(errno));
  }
  return text;
}

}  // namespace holdfast::io::files
