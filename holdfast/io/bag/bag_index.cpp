#include <algorithm>
#include <functional>
#include <iterator>

#include "holdfast/io/bag/bag_file.hpp"
#include "holdfast/io/bag/record_walker.hpp"

namespace holdfast::io::bag {
namespace {

constexpr std::size_t kIndexEntryBytes = 12;
constexpr std::size_t kChunkCountBytes = 8;

}  // namespace

bool BagFile::read_index(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks) {
  RecordWalker walker(file_);
  std::uint32_t connections_found = 0;
  while (position < file_.size()) {
    const auto record = walker.record_at(position);
    if (!record) return false;
    const auto data = walker.data_of(*record);
    if (!data) return false;
    const auto op = record->fields().op();
    if (op == Op::kConnection) ++connections_found;
    const bool good = op == Op::kConnection  ? add_connection(record->fields(), *data)
                      : op == Op::kChunkInfo ? read_chunk_info(record->fields(), *data)
                                             : false;
    if (!good) return false;
    position = record->end();
  }
  return connections_found == connections && chunks_.size() == chunks;
}

bool BagFile::read_chunk_info(const Fields& fields, std::string_view data) {
  const auto position = fields.number<std::uint64_t>("chunk_pos");
  const auto count = fields.number<std::uint32_t>("count");
  const auto begin = fields.time("start_time");
  const auto end = fields.time("end_time");
  if (!position || !count || !begin || !end || data.size() / kChunkCountBytes < *count)
    return false;
  Chunk chunk;
  chunk.position = *position;
  files::ByteReader reader(data);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const auto id = reader.number<std::uint32_t>();
    const auto messages = reader.number<std::uint32_t>();
    const auto connection = connection_index_.find(id);
    if (connection == connection_index_.end()) return false;
    connections_[connection->second].messages += messages;
    chunk.counts.emplace_back(id, messages);
  }
  begin_ = chunks_.empty() ? *begin : std::min(begin_, *begin);
  end_ = chunks_.empty() ? *end : std::max(end_, *end);
  chunks_.push_back(std::move(chunk));
  return true;
}

std::vector<MessagePlace> BagFile::list_messages(const std::vector<bool>& wanted,
                                                 std::uint64_t& lost) {
  std::vector<MessagePlace> messages;
  const auto is_wanted = [&wanted](const MessagePlace& m) {
    return m.connection < wanted.size() && wanted[m.connection];  // a scan may find further ones
  };
  if (truncated_) {
    std::copy_if(scanned_.begin(), scanned_.end(), std::back_inserter(messages), is_wanted);
  }
  for (std::uint32_t chunk = 0; !truncated_ && chunk < chunks_.size(); ++chunk) {
    std::uint64_t promised = 0;
    for (const auto& [id, count] : chunks_[chunk].counts) {
      if (wanted[connection_index_[id]]) promised += count;
    }
    if (promised == 0) continue;
    std::vector<MessagePlace> found;
    if (!list_chunk(chunk, wanted, found) || found.size() != promised) {
      found.clear();
      scan_chunk(chunk, found);
      std::erase_if(found, std::not_fn(is_wanted));
    }
    lost += promised - std::min<std::uint64_t>(promised, found.size());
    messages.insert(messages.end(), found.begin(), found.end());
  }
  std::sort(messages.begin(), messages.end());
  return messages;
}

bool BagFile::list_chunk(std::uint32_t chunk, const std::vector<bool>& wanted,
                         std::vector<MessagePlace>& out) {
  RecordWalker walker(file_);
  const auto header = walker.record_at(chunks_[chunk].position);
  if (!header || header->fields().op() != Op::kChunk ||
      !parse_chunk_header(header->fields(), header->data, header->data_size, chunks_[chunk])) {
    return false;
  }
  std::uint64_t position = header->end();
  for (std::size_t i = 0; i < chunks_[chunk].counts.size(); ++i) {
    const auto record = walker.record_at(position);
    if (!record || record->fields().op() != Op::kIndex) return false;
    const auto id = record->fields().number<std::uint32_t>("conn");
    const auto connection = id ? connection_index_.find(*id) : connection_index_.end();
    if (connection == connection_index_.end()) return false;
    if (wanted[connection->second]) {
      const auto data = walker.data_of(*record);
      if (!data) return false;
      append_index_entries(chunk, connection->second, *data, out);
    }
    position = record->end();
  }
  return true;
}

void BagFile::append_index_entries(std::uint32_t chunk, std::uint32_t connection,
                                   std::string_view data, std::vector<MessagePlace>& out) const {
  files::ByteReader reader(data);
  while (reader.left() >= kIndexEntryBytes) {
    const auto seconds = reader.number<std::uint32_t>();
    const auto nanoseconds = reader.number<std::uint32_t>();
    const auto offset = reader.number<std::uint32_t>();
    out.push_back({seconds * kSecond + nanoseconds, chunk, offset, connection});
  }
}

}  // namespace holdfast::io::bag
