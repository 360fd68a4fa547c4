#include <algorithm>

#include "holdfast/io/bag/bag_file.hpp"
#include "holdfast/io/bag/record_walker.hpp"

namespace holdfast::io::bag {
namespace {

// Recorders begin a new chunk after 768 kB; more than this is a damaged length.
constexpr std::uint32_t kLargestChunk = 1U << 30;

}  // namespace

bool BagFile::parse_chunk_header(const Fields& fields, std::uint64_t data,
                                 std::uint32_t packed_size, Chunk& chunk) const {
  const auto compression = fields.find("compression");
  const auto size = fields.number<std::uint32_t>("size");
  if (!compression || !size || data > file_.size()) return false;
  if (*size > kLargestChunk || packed_size > kLargestChunk) return false;
  chunk.compression = parse_compression(*compression);
  const std::uint64_t left = file_.size() - data;
  chunk.is_cut = packed_size > left;
  chunk.data = data;
  chunk.packed_size = static_cast<std::uint32_t>(std::min<std::uint64_t>(packed_size, left));
  chunk.size = *size;
  return chunk.compression != Compression::kUnknown;
}

void BagFile::scan() {
  connections_.clear();
  connection_index_.clear();
  chunks_.clear();
  truncated_ = true;
  RecordWalker walker(file_);
  std::uint64_t position = kMagic.size();
  while (position < file_.size()) {
    const auto record = walker.record_at(position);
    const auto op = record ? record->fields().op() : std::nullopt;
    if (!op) break;
    if (*op == Op::kConnection) {
      const auto data = walker.data_of(*record);
      if (data) add_connection(record->fields(), *data);
    }
    if (*op == Op::kChunk) {
      Chunk chunk;
      if (parse_chunk_header(record->fields(), record->data, record->data_size, chunk)) {
        chunks_.push_back(std::move(chunk));
        scan_chunk(static_cast<std::uint32_t>(chunks_.size() - 1), scanned_);
      }
    }
    position = record->end();
  }
  for (const auto& message : scanned_) {
    ++connections_[message.connection].messages;
    begin_ = &message == scanned_.data() ? message.time : std::min(begin_, message.time);
    end_ = &message == scanned_.data() ? message.time : std::max(end_, message.time);
  }
}

void BagFile::scan_chunk(std::uint32_t chunk, std::vector<MessagePlace>& out) {
  if (chunks_[chunk].compression == Compression::kUnknown) return;
  const auto bytes = load(chunk);
  if (!bytes) return;
  files::ByteReader reader(*bytes);
  while (reader.left() > 0) {
    const auto offset = static_cast<std::uint32_t>(bytes->size() - reader.left());
    const auto record = take_record(reader);
    const auto op = record ? record->header.op() : std::nullopt;
    if (!op) return;
    if (*op == Op::kConnection) add_connection(record->header, record->data);
    if (*op != Op::kMessage) continue;
    const auto id = record->header.number<std::uint32_t>("conn");
    const auto time = record->header.time("time");
    const auto connection = id ? connection_index_.find(*id) : connection_index_.end();
    if (!time || connection == connection_index_.end()) continue;
    out.push_back({*time, chunk, offset, connection->second});
  }
}

bool BagFile::add_connection(const Fields& fields, std::string_view data) {
  const auto id = fields.number<std::uint32_t>("conn");
  const auto topic = fields.find("topic");
  const Fields about(data);
  const auto type = about.find("type");
  const auto md5 = about.find("md5sum");
  if (!id || !topic || !type || !md5) return false;
  if (connection_index_.count(*id) != 0) return true;
  Connection connection;
  connection.id = *id;
  connection.topic = *topic;
  connection.type = *type;
  connection.md5 = *md5;
  connection_index_[*id] = static_cast<std::uint32_t>(connections_.size());
  connections_.push_back(std::move(connection));
  return true;
}

}  // namespace holdfast::io::bag
