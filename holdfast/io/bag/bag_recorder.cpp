#include "holdfast/io/bag/bag_recorder.hpp"

#include <algorithm>
#include <utility>

#include "holdfast/io/bag/bag_chunk.hpp"
#include "holdfast/io/bag/bag_records.hpp"

namespace holdfast::io::bag {
namespace {

constexpr std::size_t kChunkBytes = 768UL * 1024;
// The file header is padded, so that it can be rewritten when the index stands.
constexpr std::size_t kFileHeaderBytes = 4096;

std::string time_bytes(TimeNs t) {
  std::string bytes;
  append_time(bytes, t);
  return bytes;
}

std::string record(std::string_view header, std::string_view data) {
  std::string out;
  files::append_counted(out, header);
  files::append_counted(out, data);
  return out;
}

}  // namespace

BagRecorder::BagRecorder(files::StagedFile file, std::vector<TopicInfo> topics, bool compress)
    : file_(std::move(file)),
      topics_(std::move(topics)),
      compress_(compress),
      introduced_(topics_.size(), false),
      index_(topics_.size()) {}

Result<BagRecorder> BagRecorder::create(const std::filesystem::path& path,
                                        std::vector<TopicInfo> topics, bool compress) {
  auto file = files::StagedFile::create(path);
  if (!file) return file.error();
  BagRecorder recorder(std::move(*file), std::move(topics), compress);
  const auto begun = recorder.file_.write(std::string(kMagic) + recorder.file_header(0));
  if (!begun) return begun.error();
  return recorder;
}

std::string BagRecorder::file_header(std::uint64_t index_position) const {
  std::string header;
  append_number_field(header, "chunk_count", static_cast<std::uint32_t>(chunks_.size()));
  append_number_field(header, "conn_count", static_cast<std::uint32_t>(topics_.size()));
  append_number_field(header, "index_pos", index_position);
  append_op(header, Op::kFileHeader);
  return record(header, std::string(kFileHeaderBytes - header.size(), ' '));
}

std::string BagRecorder::connection_record(std::size_t topic) const {
  const TopicInfo& info = topics_[topic];
  std::string header;
  append_number_field(header, "conn", static_cast<std::uint32_t>(topic));
  append_op(header, Op::kConnection);
  append_field(header, "topic", info.topic);
  std::string data;
  append_field(data, "md5sum", info.md5);
  append_field(data, "message_definition", info.definition);
  append_field(data, "topic", info.topic);
  append_field(data, "type", info.type);
  return record(header, data);
}

Status BagRecorder::write(std::size_t topic, TimeNs time, std::string_view message) {
  if (chunk_.empty()) {
    chunks_.push_back({file_.size(), time, time, std::vector<std::uint32_t>(topics_.size(), 0)});
  }
  if (!introduced_[topic]) chunk_ += connection_record(topic);
  introduced_[topic] = true;
  ChunkInfo& info = chunks_.back();
  info.begin = std::min(info.begin, time);
  info.end = std::max(info.end, time);
  ++info.counts[topic];
  index_[topic].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  std::string header;
  append_number_field(header, "conn", static_cast<std::uint32_t>(topic));
  append_op(header, Op::kMessage);
  append_field(header, "time", time_bytes(time));
  files::append_counted(chunk_, header);
  files::append_counted(chunk_, message);
  return chunk_.size() < kChunkBytes ? Status(Done{}) : flush_chunk();
}

/// Writes the chunk and, behind it, where the messages of each topic stand in it.
Status BagRecorder::flush_chunk() {
  if (chunk_.empty()) return Done{};
  std::string header;
  append_field(header, "compression", compress_ ? "lz4" : "none");
  append_op(header, Op::kChunk);
  append_number_field(header, "size", static_cast<std::uint32_t>(chunk_.size()));
  std::string out;
  files::append_counted(out, header);
  files::append_counted(out, compress_ ? pack_lz4(chunk_) : chunk_);
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    auto& entries = index_[topic];
    if (entries.empty()) continue;
    header.clear();
    append_number_field(header, "conn", static_cast<std::uint32_t>(topic));
    append_number_field(header, "count", static_cast<std::uint32_t>(entries.size()));
    append_op(header, Op::kIndex);
    append_number_field(header, "ver", std::uint32_t{1});
    std::string data;
    for (const auto& entry : entries) {
      append_time(data, entry.time);
      files::append(data, entry.offset);
    }
    out += record(header, data);
    entries.clear();
  }
  chunk_.clear();
  return file_.write(out);
}

Status BagRecorder::close() {
  auto flushed = flush_chunk();
  if (!flushed) return flushed;
  const std::uint64_t index_position = file_.size();
  std::string out;
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) out += connection_record(topic);
  for (const auto& chunk : chunks_) {
    std::string data;
    std::uint32_t used = 0;
    for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
      if (chunk.counts[topic] == 0) continue;
      files::append(data, static_cast<std::uint32_t>(topic));
      files::append(data, chunk.counts[topic]);
      ++used;
    }
    std::string header;
    append_number_field(header, "chunk_pos", chunk.position);
    append_number_field(header, "count", used);
    append_field(header, "end_time", time_bytes(chunk.end));
    append_op(header, Op::kChunkInfo);
    append_field(header, "start_time", time_bytes(chunk.begin));
    append_number_field(header, "ver", std::uint32_t{1});
    out += record(header, data);
  }
  auto indexed = file_.write(out);
  if (!indexed) return indexed;
  const auto finished = file_.rewrite(kMagic.size(), file_header(index_position));
  return finished ? file_.commit() : finished;
}

}  // namespace holdfast::io::bag
