#include "holdfast/map/tile.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace holdfast::map {
namespace {

/// True if [offset, offset + bytes) lies in the file and is aligned to 4 bytes.
bool inside(std::uint64_t offset, std::uint64_t bytes, std::uint64_t size) {
  return offset % 4 == 0 && offset <= size && bytes <= size - offset;
}

bool fits(const LevelHeader& level, std::uint64_t size) {
  constexpr std::int32_t kMostBlocks = 4096;
  constexpr std::int32_t kFarthestBlock = 1 << 20;
  if (!(level.cell_m > 0) || level.blocks_xy < 0 || level.blocks_xy > kMostBlocks ||
      level.blocks_z < 0 || level.blocks_z > kMostBlocks || level.z_block < -kFarthestBlock ||
      level.z_block > kFarthestBlock) {
    return false;
  }
  const auto index_entries =
      static_cast<std::uint64_t>(level.blocks_xy) * level.blocks_xy * level.blocks_z;
  return inside(level.index_offset, 4 * index_entries, size) &&
         inside(level.blocks_offset, 4ULL * kCellsPerBlock * level.block_count, size) &&
         inside(level.surfaces_offset, sizeof(Surface) * level.surface_count, size);
}

}  // namespace

Result<Tile> Tile::open(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return Error{fmt::format("{}: cannot open tile: {}", path.string(), std::strerror(errno))};
  }
  struct stat status {};
  const bool sized = ::fstat(file, &status) == 0;
  const auto size = static_cast<std::size_t>(status.st_size);
  if (!sized || size < sizeof(TileHeader)) {
    ::close(file);
    return Error{fmt::format("{}: not a tile: {} bytes, at least {} expected", path.string(), size,
                             sizeof(TileHeader))};
  }
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_POPULATE, file, 0);
  ::close(file);
  if (data == MAP_FAILED) {
    return Error{fmt::format("{}: cannot map tile: {}", path.string(), std::strerror(errno))};
  }
  Tile tile(static_cast<const std::byte*>(data), size);
  if (auto bound = tile.bind(path); !bound) return bound.error();
  return tile;
}

Status Tile::bind(const std::filesystem::path& path) {
  const TileHeader& h = header();
  if (h.magic != kTileMagic) return Error{fmt::format("{}: not a holdfast tile", path.string())};
  if (h.version != kTileVersion) {
    return Error{fmt::format("{}: tile format {}, this program reads {}", path.string(), h.version,
                             kTileVersion)};
  }
  if (h.file_size != size_) {
    return Error{fmt::format("{}: {} bytes, its header says {}: the file was cut off",
                             path.string(), size_, h.file_size)};
  }
  for (int i = 0; i < kLevels; ++i) {
    const LevelHeader& from = h.levels[i];
    if (!fits(from, size_)) {
      return Error{fmt::format("{}: level {} points outside of the file", path.string(), i)};
    }
    levels_[i] = {1.0F / from.cell_m,
                  -static_cast<float>(from.z_block * kBlockCells),
                  from.blocks_xy,
                  from.blocks_z,
                  reinterpret_cast<const std::uint32_t*>(data_ + from.index_offset),
                  reinterpret_cast<const std::uint32_t*>(data_ + from.blocks_offset),
                  reinterpret_cast<const Surface*>(data_ + from.surfaces_offset)};
  }
  return Done{};
}

Tile::Tile(Tile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      levels_(other.levels_) {}

Tile& Tile::operator=(Tile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(levels_, other.levels_);
  return *this;
}

Tile::~Tile() {
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

}  // namespace holdfast::map
