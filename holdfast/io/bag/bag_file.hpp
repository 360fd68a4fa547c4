#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/time.hpp"
#include "holdfast/io/bag/bag_chunk.hpp"
#include "holdfast/io/bag/bag_records.hpp"
#include "holdfast/io/files/input_file.hpp"

namespace holdfast::io::bag {

/// What a publisher told about the messages of one connection.
struct Connection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;
  std::string md5;
  std::uint64_t messages = 0;
};

/// Where a message stands.
struct MessagePlace {
  TimeNs time = 0;  ///< when it was recorded
  std::uint32_t chunk = 0;
  std::uint32_t offset = 0;      ///< of its record in the unpacked chunk
  std::uint32_t connection = 0;  ///< index into connections()

  friend bool operator<(const MessagePlace& a, const MessagePlace& b) {
    return std::tie(a.time, a.chunk, a.offset) < std::tie(b.time, b.chunk, b.offset);
  }
};

/// A ROS 1 bag of format 2.0, read through its index; where that is missing or damaged (a recording
/// that was cut off), by walking through all that is there. Nothing in the file is trusted: a
/// damaged bag yields fewer messages, never memory that is not its own.
class BagFile {
 public:
  static Result<BagFile> open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  const std::vector<Connection>& connections() const { return connections_; }
  /// Whether the index is missing or the file ends early.
  bool truncated() const { return truncated_; }
  /// From the first to the last record.
  TimeNs duration() const { return end_ - begin_; }

  /// All messages of the connections with wanted[index], in order of their record times (equal ones
  /// in the order of the file). `lost` counts those that the index promises and that are not there.
  std::vector<MessagePlace> list_messages(const std::vector<bool>& wanted, std::uint64_t& lost);

  /// The serialised message, valid until the next call; empty if it is damaged.
  std::optional<std::string_view> read(const MessagePlace& message);

 private:
  struct Chunk {
    std::uint64_t data = 0;
    std::uint32_t packed_size = 0;
    std::uint32_t size = 0;
    Compression compression = Compression::kUnknown;
    bool is_cut = false;                                          ///< the file ends in it
    std::uint64_t position = 0;                                   ///< of its record
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  ///< connection id, messages
  };
  struct LoadedChunk {
    std::optional<std::uint32_t> chunk;
    bool usable = false;
    Buffer bytes;
  };

  explicit BagFile(files::InputFile file) : file_(std::move(file)) {}

  // bag_index.cpp: through the index
  bool read_index(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks);
  bool read_chunk_info(const Fields& fields, std::string_view data);
  bool list_chunk(std::uint32_t chunk, const std::vector<bool>& wanted,
                  std::vector<MessagePlace>& out);
  void append_index_entries(std::uint32_t chunk, std::uint32_t connection, std::string_view data,
                            std::vector<MessagePlace>& out) const;

  // bag_scan.cpp: through everything
  void scan();
  bool parse_chunk_header(const Fields& fields, std::uint64_t data, std::uint32_t packed_size,
                          Chunk& chunk) const;
  void scan_chunk(std::uint32_t chunk, std::vector<MessagePlace>& out);
  bool add_connection(const Fields& fields, std::string_view data);

  std::optional<std::string_view> load(std::uint32_t chunk);

  files::InputFile file_;
  std::vector<Connection> connections_;
  std::map<std::uint32_t, std::uint32_t> connection_index_;  ///< from id
  std::vector<Chunk> chunks_;
  std::vector<MessagePlace> scanned_;  ///< filled by scan() only
  bool truncated_ = false;
  TimeNs begin_ = 0;
  TimeNs end_ = 0;
  std::array<LoadedChunk, 2> loaded_;  ///< the one used last first
  Buffer packed_;
};

}  // namespace holdfast::io::bag
