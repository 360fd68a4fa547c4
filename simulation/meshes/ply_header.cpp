#include "simulation/meshes/ply_header.hpp"

#include <fstream>
#include <sstream>
#include <string>

namespace holdfast::simulation {
namespace {

constexpr int kMostLines = 1000;
constexpr std::uint64_t kShortestFace = 3;  // corners

std::uint64_t bytes_of(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  return type == "double" || type == "float64" ? 8 : 4;
}

/// Bytes of one property of an entry, after the word "property".
std::uint64_t property_bytes(std::istringstream& words) {
  std::string type, count, item;
  words >> type;
  if (type != "list") return bytes_of(type);
  words >> count >> item;
  return bytes_of(count) + kShortestFace * bytes_of(item);
}

}  // namespace

std::optional<PlyHeader> read_ply_header(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  PlyHeader header;
  std::uint64_t count = 0;  // of the element whose properties follow
  std::string line;
  for (int i = 0; i < kMostLines && std::getline(file, line); ++i) {
    std::istringstream words(line);
    std::string word, name;
    words >> word;
    if (word == "end_header") {
      header.header_bytes = static_cast<std::uint64_t>(file.tellg());
      return header;
    }
    if (word == "format" && words >> name) header.is_ascii = name == "ascii";
    if (word == "element" && words >> name >> count) {
      header.entries += count;
      if (name == "face") header.faces = count;
    }
    if (word == "property") header.entry_bytes += count * property_bytes(words);
  }
  return {};
}

bool is_cut_off(const std::filesystem::path& path, const PlyHeader& header) {
  if (!header.is_ascii) {
    return std::filesystem::file_size(path) < header.header_bytes + header.entry_bytes;
  }
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(header.header_bytes));
  std::uint64_t lines = 0;
  std::string line;
  while (lines < header.entries && std::getline(file, line)) {
    lines += line.find_first_not_of(" \t\r") == std::string::npos ? 0U : 1U;
  }
  return lines < header.entries;
}

}  // namespace holdfast::simulation
