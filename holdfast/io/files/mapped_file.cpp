#include "holdfast/io/files/mapped_file.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/input_file.hpp"

namespace holdfast::io::files {

MappedFile::MappedFile(MappedFile&& other) noexcept
    : bytes_(std::exchange(other.bytes_, std::string_view{})) {}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  if (!file) return file.error();
  if (file->size() == 0) return MappedFile({});
  const auto size = static_cast<std::size_t>(file->size());
  void* start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file->descriptor(), 0);
  if (start == MAP_FAILED) return error_at(path, "cannot be mapped: {}", std::strerror(errno));
  ::madvise(start, size, MADV_SEQUENTIAL);
  return MappedFile({static_cast<const char*>(start), size});
}

}  // namespace holdfast::io::files
