#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/core/time.hpp"
#include "holdfast/io/files/staged_file.hpp"

namespace holdfast::io::bag {

/// What a connection record tells about the messages of a topic.
struct TopicInfo {
  std::string topic;
  std::string_view type;
  std::string_view md5;
  std::string definition;
};

/// Writes serialised messages as a ROS bag of format 2.0 with an index.
class BagRecorder {
 public:
  static Result<BagRecorder> create(const std::filesystem::path& path,
                                    std::vector<TopicInfo> topics, bool compress);

  /// Appends a message of topics[topic], recorded at `time` in [0, 2^32) s.
  Status write(std::size_t topic, TimeNs time, std::string_view message);
  Status close();

 private:
  struct IndexEntry {
    TimeNs time;
    std::uint32_t offset;
  };
  struct ChunkInfo {
    std::uint64_t position = 0;
    TimeNs begin = 0;
    TimeNs end = 0;
    std::vector<std::uint32_t> counts;  ///< by topic
  };

  BagRecorder(files::StagedFile file, std::vector<TopicInfo> topics, bool compress);
  std::string file_header(std::uint64_t index_position) const;
  std::string connection_record(std::size_t topic) const;
  Status flush_chunk();

  files::StagedFile file_;
  std::vector<TopicInfo> topics_;
  bool compress_;
  std::vector<bool> introduced_;  ///< topics whose connection record is in a chunk
  std::string chunk_;
  std::vector<std::vector<IndexEntry>> index_;  ///< of the chunk, by topic
  std::vector<ChunkInfo> chunks_;
};

}  // namespace holdfast::io::bag
