#include <gtest/gtest.h>

#include <functional>

#include "holdfast/core/random.hpp"
#include "holdfast/io/bag_writer.hpp"
#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/tum_file.hpp"
#include "tests/io/clouds/cloud_bytes.hpp"
#include "tests/io/logs/log_content.hpp"
#include "tests/io/logs/message_builder.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

/// A copy with a few bytes changed, a part cut out or doubled, or the end cut off.
std::string damaged(std::string bytes, RandomStream& random) {
  const auto place = [&] { return static_cast<std::size_t>(random.below(bytes.size())); };
  switch (random.below(4)) {
    case 0: bytes.resize(place()); break;
    case 1: bytes.erase(place(), 1 + random.below(64)); break;
    case 2: bytes.insert(place(), bytes.substr(place(), 1 + random.below(64))); break;
    default: break;
  }
  const auto flips = bytes.empty() ? 0 : random.below(8);
  for (std::uint64_t i = 0; i < flips; ++i) {
    // Whole words too: lengths and offsets are where it hurts.
    const std::size_t at = place();
    const std::size_t size = random.below(2) == 0 ? 1 : 4;
    const std::uint64_t value = random.below(3) == 0 ? ~std::uint64_t{0} : random.next_u64();
    for (std::size_t k = 0; k < size && at + k < bytes.size(); ++k) {
      bytes[at + k] = static_cast<char>(value >> (8 * k));
    }
  }
  return bytes;
}

/// Whatever is damaged, readers end, stay within their memory (the sanitizers tell) and hand out
/// nothing that breaks their contract.
struct RandomDamage : ::testing::Test {
  TemporaryFolder folder;
  RandomStream random{20261122, "random_damage"};

  void repeat(const std::string& name, const std::string& bytes, int times,
              const std::function<void(const std::filesystem::path&)>& read) {
    for (int i = 0; i < times && !HasFailure(); ++i) {
      const auto path = folder.put(name, damaged(bytes, random));
      read(path);
      if (HasFailure()) {
        std::filesystem::copy(path, std::filesystem::temp_directory_path() / ("damaged_" + name),
                              std::filesystem::copy_options::overwrite_existing);
      }
    }
  }

  static void check_log(const std::filesystem::path& path) {
    auto log = open_log(path, {});
    if (!log) {
      EXPECT_FALSE(log.error().message.empty());
      return;
    }
    const auto content = drain(**log);
    TimeNs last = -1;
    for (const auto& scan : content.scans) {
      EXPECT_GT(scan.stamp, last);
      EXPECT_GE(scan.end_time, scan.stamp);
      last = scan.stamp;
      for (const auto& p : scan.points) {
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        ASSERT_GE(p.time_offset_ns, 0);
        ASSERT_LE(scan.stamp + p.time_offset_ns, scan.end_time);
      }
    }
    last = -1;
    for (const auto& sample : content.imu) {
      EXPECT_GT(sample.t, last);
      last = sample.t;
      EXPECT_TRUE(sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite());
    }
  }

  static void check_cloud(const std::filesystem::path& path) {
    const auto cloud = read_cloud(path);
    if (!cloud) {
      EXPECT_FALSE(cloud.error().message.empty());
      return;
    }
    EXPECT_FALSE(cloud->points.empty());
    EXPECT_TRUE(cloud->origin.allFinite());
    EXPECT_TRUE(cloud->intensity.empty() || cloud->intensity.size() == cloud->points.size());
    for (const auto& p : cloud->points) ASSERT_TRUE(p.allFinite());
  }

  std::string small_bag(bool compress) {
    const auto path = folder / "small.bag";
    auto writer = BagWriter::create(path, {}, compress);
    EXPECT_TRUE(writer);
    for (int i = 0; i < 4; ++i) {
      Scan scan;
      scan.stamp = kStart + i * kPeriod;
      scan.has_ring = scan.has_point_times = true;
      for (int k = 0; k < 20; ++k) {
        scan.points.push_back({1.0F + static_cast<float>(k), 2, 3, 4, k * 5'000'000, 1});
      }
      scan.end_time = scan.stamp + scan.points.back().time_offset_ns;
      EXPECT_TRUE((*writer)->write(imu_at(scan.stamp)));
      EXPECT_TRUE((*writer)->write(scan));
    }
    EXPECT_TRUE((*writer)->close());
    return read_bytes(path);
  }

  PointCloud small_cloud() {
    PointCloud cloud;
    for (int i = 0; i < 30; ++i) {
      cloud.points.emplace_back(static_cast<float>(i % 5), 2, 3);
      cloud.intensity.push_back(static_cast<float>(i));
    }
    return cloud;
  }
  std::string written(const std::string& name, const PointCloud& cloud) {
    EXPECT_TRUE(write_cloud(folder / name, cloud));
    return read_bytes(folder / name);
  }
};

TEST_F(RandomDamage, NoBagBreaksItsReader) { repeat("d.bag", small_bag(false), 1500, check_log); }

TEST_F(RandomDamage, NoCompressedBagBreaksItsReader) {
  repeat("d.bag", small_bag(true), 700, check_log);
}

TEST_F(RandomDamage, NoMessageBreaksItsReader) {
  // Only the messages are damaged, in a bag that is sound.
  const auto cloud =
      timed_cloud<double>(kStart, "timestamp", kF64, {1.7e9, 1.7e9 + 0.05, 1.7e9 + 0.09})
          .serialised();
  const auto imu = ros::serialise_imu(imu_at(kStart), 0, "imu");
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    BagBytes bag(folder / "m.bag");
    bag.add(1, kStart, imu);
    for (int k = 0; k < 4; ++k) {
      bag.add(0, kStart, damaged(cloud, random));
      bag.add(1, kStart, damaged(imu, random));
    }
    check_log(bag.finish());
  }
}

TEST_F(RandomDamage, NoPcdBreaksItsReader) {
  repeat("d.pcd", written("c.pcd", small_cloud()), 1000, check_cloud);
  const std::string head =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ";
  repeat("d.pcd", head + "ascii\n1 2 3\n4 nan 6\n7 8.5e0 -9\n", 1000, check_cloud);
  std::string columns;
  for (int i = 0; i < 9; ++i) files::append(columns, static_cast<float>(i % 2));
  const auto packed = lzf_pack(columns);
  std::string bytes = head + "binary_compressed\n";
  files::append(bytes, static_cast<std::uint32_t>(packed.size()));
  files::append(bytes, static_cast<std::uint32_t>(columns.size()));
  repeat("d.pcd", bytes + packed, 1000, check_cloud);
}

TEST_F(RandomDamage, NoPlyBreaksItsReader) {
  repeat("d.ply", written("c.ply", small_cloud()), 1000, check_cloud);
  auto far = small_cloud();
  far.origin = {5e5, 5e6, 0};
  repeat("d.ply", written("c.ply", far), 500, check_cloud);
  repeat("d.ply",
         "ply\nformat ascii 1.0\nelement edge 1\nproperty list uchar int i\nelement vertex 2\n"
         "property float x\nproperty double y\nproperty float z\nend_header\n2 0 1\n1 2 3\n4 5 6\n",
         1000, check_cloud);
  repeat("d.ply",
         "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list uint int i\n"
         "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n" +
             std::string("\0\0\0\1\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 20),
         1000, check_cloud);
}

TEST_F(RandomDamage, NoTrajectoryBreaksItsReader) {
  const std::string text =
      "# t x y z qx qy qz qw\n1700000000.000000001 1 2 3 0 0 0 1\n1700000001.5 1 2 3 0 0.6 0 0.8\n";
  repeat("d.tum", text, 3000, [](const std::filesystem::path& path) {
    const auto poses = read_tum(path);
    if (!poses) {
      EXPECT_FALSE(poses.error().message.empty());
      return;
    }
    for (const auto& pose : *poses) {
      EXPECT_TRUE(pose.T_map_body.translation.allFinite());
      EXPECT_NEAR(pose.T_map_body.rotation.norm(), 1, 1e-12);
    }
  });
}

}  // namespace
}  // namespace holdfast::io::testing
