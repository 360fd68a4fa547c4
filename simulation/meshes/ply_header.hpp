#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace holdfast::simulation {

/// What the header of a .ply file promises.
struct PlyHeader {
  bool is_ascii = true;
  std::uint64_t faces = 0;
  std::uint64_t entries = 0;       ///< of all elements: one a line in an ascii file
  std::uint64_t header_bytes = 0;  ///< up to the first entry
  std::uint64_t entry_bytes = 0;   ///< of a binary file, at least; lists count three values
};

/// Empty when there is no file or no whole header in it.
std::optional<PlyHeader> read_ply_header(const std::filesystem::path& path);

/// True when the file ends before all that its header promises.
bool is_cut_off(const std::filesystem::path& path, const PlyHeader& header);

}  // namespace holdfast::simulation
