#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/map/map_info.hpp"

/// Files of a map and their checksums.
namespace holdfast::map {

constexpr std::string_view kPlacesFileName = "places.bin";

/// The content of a file of which map.yaml says size and checksum. Errors name the file.
Result<std::vector<std::byte>> read_checked(const std::filesystem::path& path, std::uint64_t bytes,
                                            std::uint64_t sum);

/// Writes a file into a map that is being made; returns what map.yaml is to say of it.
Result<FileInfo> write_summed(const std::filesystem::path& path,
                              const std::vector<std::byte>& content);

}  // namespace holdfast::map
