#include "holdfast/map/map_files.hpp"

#include <fmt/format.h>

#include <fstream>

#include "holdfast/map/checksum.hpp"

namespace holdfast::map {

Result<std::vector<std::byte>> read_checked(const std::filesystem::path& path, std::uint64_t bytes,
                                            std::uint64_t sum) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return Error{fmt::format("{}: cannot open", path.string())};
  const auto size = static_cast<std::uint64_t>(file.tellg());
  if (size != bytes) {
    return Error{fmt::format("{}: {} bytes, map.yaml says {}", path.string(), size, bytes)};
  }
  std::vector<std::byte> content(size);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(content.data()), static_cast<std::streamsize>(size));
  if (!file || checksum(content.data(), size) != sum) {
    return Error{
        fmt::format("{}: content does not match its checksum in map.yaml: import the map "
                    "again",
                    path.string())};
  }
  return content;
}

Result<FileInfo> write_summed(const std::filesystem::path& path,
                              const std::vector<std::byte>& content) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(content.data()),
             static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) return Error{fmt::format("{}: cannot write {} bytes", path.string(), content.size())};
  return FileInfo{content.size(), checksum(content.data(), content.size())};
}

}  // namespace holdfast::map
