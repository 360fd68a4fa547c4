#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "holdfast/io/bag/bag_chunk.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::HasSubstr;

/// A bag of 60 scans of 1500 points and 120 samples in several chunks.
std::string write_bag(const TemporaryFolder& folder, bool compress) {
  const auto path = folder / "whole.bag";
  auto writer = BagWriter::create(path, {}, compress);
  EXPECT_TRUE(writer);
  for (int i = 0; i < 60; ++i) {
    Scan scan;
    scan.stamp = kStart + i * kPeriod;
    scan.has_point_times = true;
    for (int k = 0; k < 1500; ++k) {
      scan.points.push_back(
          {1.0F + static_cast<float>(k), static_cast<float>(i), 3, 4, k * 60'000, 0});
    }
    scan.end_time = scan.stamp + scan.points.back().time_offset_ns;
    EXPECT_TRUE((*writer)->write(imu_at(scan.stamp)));
    EXPECT_TRUE((*writer)->write(imu_at(scan.stamp + kPeriod / 2)));
    EXPECT_TRUE((*writer)->write(scan));
  }
  EXPECT_TRUE((*writer)->close());
  return read_bytes(path);
}

/// Bytes of the file behind its index.
std::uint64_t index_position(const std::string& bag) {
  const std::string name = "index_pos=";
  return files::load<std::uint64_t>(bag.data() + bag.find(name) + name.size());
}

struct DamagedBag : ::testing::Test {
  TemporaryFolder folder;

  LogContent content_of(const std::string& bytes) { return read_log(folder.put("cut.bag", bytes)); }

  /// What is there is the beginning of the whole log.
  static void expect_beginning(const LogContent& part, std::size_t at_least) {
    EXPECT_GE(part.scans.size(), at_least);
    for (std::size_t i = 0; i < part.scans.size(); ++i) {
      ASSERT_EQ(part.scans[i].stamp, kStart + static_cast<TimeNs>(i) * kPeriod);
      ASSERT_EQ(part.scans[i].points.size(), 1500U);
      ASSERT_EQ(part.scans[i].points[7].y, static_cast<float>(i));
    }
    EXPECT_GE(part.imu.size() + 2, 2 * part.scans.size());
  }
};

TEST_F(DamagedBag, ACutBagYieldsWhatCameBeforeTheCut) {
  const std::string whole = write_bag(folder, false);
  for (const double share : {0.99, 0.9, 0.5, 0.1}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    const auto part = content_of(whole.substr(0, size));
    EXPECT_TRUE(part.counters.truncated);
    expect_beginning(part, static_cast<std::size_t>(share * 60) - 1);
    EXPECT_EQ(part.counters.bad_messages, 0U);
  }
}

TEST_F(DamagedBag, ACutCompressedBagYieldsWhatCanBeUnpacked) {
  const std::string whole = write_bag(folder, true);
  const auto part = content_of(whole.substr(0, whole.size() / 2));
  EXPECT_TRUE(part.counters.truncated);
  expect_beginning(part, 20);
}

TEST_F(DamagedBag, ABagThatWasNeverClosedIsReadWhole) {
  std::string bag = write_bag(folder, false);
  const std::string name = "index_pos=";
  const auto index = index_position(bag);
  bag.replace(bag.find(name) + name.size(), 8, 8, '\0');
  bag.resize(index);
  const auto log = read_log(folder.put("now.bag.active", bag));
  EXPECT_TRUE(log.counters.truncated);
  EXPECT_EQ(log.scans.size(), 60U);
  EXPECT_EQ(log.imu.size(), 120U);
}

TEST_F(DamagedBag, ADamagedIndexIsReplacedByWalkingThroughTheFile) {
  std::string bag = write_bag(folder, false);
  bag[index_position(bag) + 1] ^= '\x40';
  const auto log = content_of(bag);
  EXPECT_EQ(log.scans.size(), 60U);
  EXPECT_TRUE(log.counters.truncated);
}

TEST_F(DamagedBag, ADamagedIndexOfAChunkIsReplacedByWalkingThroughIt) {
  std::string bag = write_bag(folder, false);
  const auto at = bag.find("ver=");  // of the first index record, behind the first chunk
  ASSERT_LT(at, index_position(bag));
  bag[bag.rfind("op=", at) + 3] = '\x2a';
  const auto log = content_of(bag);
  EXPECT_EQ(log.scans.size(), 60U);
  EXPECT_EQ(log.imu.size(), 120U);
  EXPECT_FALSE(log.counters.truncated);
  EXPECT_EQ(log.counters.bad_messages, 0U);
}

TEST_F(DamagedBag, MessagesOfADamagedChunkAreCountedAsBad) {
  std::string bag = write_bag(folder, true);
  const auto second = bag.find("compression=lz4", bag.find("compression=lz4") + 1);
  bag.replace(second + 2000, 64, 64, '\x55');  // the checksum of the frame tells
  const auto log = content_of(bag);
  EXPECT_FALSE(log.counters.truncated);
  EXPECT_GT(log.counters.bad_messages, 0U);
  EXPECT_GT(log.scans.size(), 10U);
  EXPECT_EQ(log.scans.size() + log.imu.size() + log.counters.bad_messages, 180U);
}

TEST_F(DamagedBag, AnUnknownCompressionLosesItsChunkOnly) {
  std::string bag = write_bag(folder, false);
  const auto at = bag.find("compression=none");
  bag.replace(at, 16, "compression=zstd");
  const auto log = content_of(bag);
  EXPECT_GT(log.counters.bad_messages, 0U);
  EXPECT_EQ(log.scans.size() + log.imu.size() + log.counters.bad_messages, 180U);
}

TEST_F(DamagedBag, NothingReadableIsAnError) {
  const std::string whole = write_bag(folder, false);
  EXPECT_THAT(error_of_log(folder.put("head.bag", whole.substr(0, 4117))),
              HasSubstr("head.bag: ends early: it has no index and no readable message"));
}

TEST_F(DamagedBag, ChunksOfBzip2AreRead) {
  // A bag of one bzip2 chunk, made from one that is not compressed.
  BagBytes plain(folder / "plain.bag");
  plain.add(imu_at(kStart));
  plain.add(plain_cloud(kStart, {{1, 2, 3}, {4, 5, 6}}));
  const std::string bag = read_bytes(plain.finish());
  const auto header_end = bag.find("size=") + 5 + 4;
  const auto chunk_size = files::load<std::uint32_t>(bag.data() + header_end);
  const std::string chunk = bag.substr(header_end + 4, chunk_size);
  std::string packed(chunk.size() + 1000, '\0');
  auto packed_size = static_cast<unsigned>(packed.size());
  ASSERT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &packed_size, const_cast<char*>(chunk.data()),
                                     chunk_size, 9, 0, 0),
            BZ_OK);
  packed.resize(packed_size);

  std::string header;
  bag::append_field(header, "compression", "bz2");
  bag::append_op(header, bag::Op::kChunk);
  bag::append_number_field(header, "size", chunk_size);
  std::string file = bag.substr(0, 4117);
  files::append_counted(file, header);
  files::append_counted(file, packed);
  const auto log = content_of(file);
  EXPECT_EQ(log.order, "is");
  EXPECT_EQ(log.scans.at(0).points.size(), 2U);

  bag::Buffer out;
  EXPECT_EQ(bag::unpack_chunk(bag::Compression::kBz2, packed, chunk_size, out),
            bag::Unpacked::kWhole);
  EXPECT_EQ(out.bytes(), chunk);
  EXPECT_EQ(
      bag::unpack_chunk(bag::Compression::kBz2, packed.substr(0, packed_size / 2), chunk_size, out),
      bag::Unpacked::kEndsEarly);
  std::string wrong_checksum = packed;
  wrong_checksum[12] ^= '\x01';
  EXPECT_EQ(bag::unpack_chunk(bag::Compression::kBz2, wrong_checksum, chunk_size, out),
            bag::Unpacked::kDamaged);
  packed[packed_size / 2] ^= '\x10';
  EXPECT_EQ(bag::unpack_chunk(bag::Compression::kBz2, packed, chunk_size, out),
            bag::Unpacked::kDamaged);
  EXPECT_EQ(out.bytes(), "");
}

}  // namespace
}  // namespace holdfast::io::testing
