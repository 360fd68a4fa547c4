#include "benchmarks/harness/scratch_folder.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>

namespace holdfast::benchmarks {

Result<ScratchFolder> ScratchFolder::create() {
  std::error_code failure;
  const auto root = std::filesystem::temp_directory_path(failure);
  if (failure) return Error{fmt::format("no folder for temporary files: {}", failure.message())};
  std::string name = (root / "holdfast-bench-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    return Error{
        fmt::format("{}: cannot make a temporary folder: {}", root.string(), std::strerror(errno))};
  }
  return ScratchFolder(name);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace holdfast::benchmarks
