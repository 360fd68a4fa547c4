#include "holdfast/io/bag/bag_file.hpp"

#include <algorithm>

#include "holdfast/io/bag/record_walker.hpp"
#include "holdfast/io/files/errors.hpp"

namespace holdfast::io::bag {
namespace {

using files::error_at;

Status check_magic(const files::InputFile& file) {
  std::string magic(kMagic.size(), '\0');
  magic.resize(file.read(0, magic.data(), magic.size()));
  if (magic == kMagic) return Done{};
  if (magic.rfind("#ROSBAG V", 0) == 0 || magic.rfind("#ROSRECORD V", 0) == 0) {
    return error_at(file.path(),
                    "is a bag of the older format '{}', expected '#ROSBAG V2.0' "
                    "(convert it with 'rosbag fix')",
                    magic.substr(0, magic.find('\n')));
  }
  return error_at(file.path(), "is not a ROS 1 bag: it does not begin with '#ROSBAG V2.0'");
}

}  // namespace

Result<BagFile> BagFile::open(const std::filesystem::path& path) {
  auto file = files::InputFile::open(path);
  if (!file) return file.error();
  const auto magic = check_magic(*file);
  if (!magic) return magic.error();
  BagFile bag(std::move(*file));
  const auto header = RecordWalker(bag.file_).record_at(kMagic.size());
  bool indexed = false;
  if (header && header->fields().op() == Op::kFileHeader) {
    const auto fields = header->fields();
    const auto encryptor = fields.find("encryptor").value_or("");
    if (!encryptor.empty()) {
      return error_at(path, "is encrypted (by {}) and cannot be read", encryptor);
    }
    const auto index = fields.number<std::uint64_t>("index_pos");
    const auto connections = fields.number<std::uint32_t>("conn_count");
    const auto chunks = fields.number<std::uint32_t>("chunk_count");
    indexed = index && connections && chunks && *index != 0 &&
              bag.read_index(*index, *connections, *chunks);
  }
  if (!indexed) bag.scan();
  return bag;
}

std::optional<std::string_view> BagFile::load(std::uint32_t chunk) {
  if (loaded_[0].chunk != chunk) std::swap(loaded_[0], loaded_[1]);
  auto& slot = loaded_[0];
  if (slot.chunk != chunk) {
    const Chunk& place = chunks_[chunk];
    slot.chunk = chunk;
    slot.usable = false;
    const bool plain = place.compression == Compression::kNone;
    Buffer& target = plain ? slot.bytes : packed_;
    char* room = target.make_room(place.packed_size);
    target.set_size(file_.read(place.data, room, place.packed_size));
    const auto unpacked =
        plain ? Unpacked::kWhole
              : unpack_chunk(place.compression, packed_.bytes(), place.size, slot.bytes);
    slot.usable =
        unpacked == Unpacked::kWhole || (unpacked == Unpacked::kEndsEarly && place.is_cut);
  }
  if (!slot.usable) return std::nullopt;
  return slot.bytes.bytes();
}

std::optional<std::string_view> BagFile::read(const MessagePlace& message) {
  const auto bytes = load(message.chunk);
  if (!bytes || message.offset > bytes->size()) return std::nullopt;
  files::ByteReader reader(bytes->substr(message.offset));
  const auto record = take_record(reader);
  if (!record || record->header.op() != Op::kMessage) return std::nullopt;
  if (record->header.number<std::uint32_t>("conn") != connections_[message.connection].id) {
    return std::nullopt;
  }
  return record->data;
}

}  // namespace holdfast::io::bag
