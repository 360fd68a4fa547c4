#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "holdfast/io/cloud_file.hpp"
#include "holdfast/io/clouds/lzf.hpp"
#include "tests/io/clouds/cloud_bytes.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A header with one row of points.
std::string header(std::string_view fields, std::string_view size, std::string_view type,
                   std::size_t points, std::string_view data, std::string_view count = "") {
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";
  text += "FIELDS " + std::string(fields) + "\nSIZE " + std::string(size) + "\nTYPE ";
  text += std::string(type) + "\n";
  if (!count.empty()) text += "COUNT " + std::string(count) + "\n";
  const auto n = std::to_string(points);
  text += "WIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA ";
  return text + std::string(data) + "\n";
}

struct PcdFile : ::testing::Test {
  TemporaryFolder folder;

  PointCloud cloud_of(std::string_view bytes) {
    auto cloud = read_cloud(folder.put("c.pcd", bytes));
    EXPECT_TRUE(cloud) << cloud.error().message;
    return cloud ? *cloud : PointCloud{};
  }
  std::string error_of(std::string_view bytes) {
    const auto cloud = read_cloud(folder.put("c.pcd", bytes));
    EXPECT_FALSE(cloud);
    return cloud ? "" : cloud.error().message;
  }
};

TEST_F(PcdFile, AsciiIsReadWithFieldsInAnyOrder) {
  const auto cloud = cloud_of(header("rgb intensity z y x", "4 1 4 4 4", "F U F F F", 2, "ascii") +
                              "1e-3 7 3 2 1\n\n  nan 255 -6.5 +5 4e0\r\n");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, -6.5F));
  EXPECT_THAT(cloud.intensity, ElementsAre(7, 255));
  EXPECT_TRUE(cloud.origin.isZero(0));
}

TEST_F(PcdFile, FieldsWithACountArePassedOver) {
  const auto ascii =
      cloud_of(header("x _ y z", "4 1 4 4", "F U F F", 1, "ascii", "1 3 1 1") + "1 9 9 9 2 3\n");
  EXPECT_EQ(ascii.points.at(0), Eigen::Vector3f(1, 2, 3));
  std::string bytes = header("x _ y z", "4 1 4 4", "F U F F", 1, "binary", "1 3 1 1");
  files::append(bytes, 1.0F);
  bytes += "pad";
  files::append(bytes, 2.0F);
  files::append(bytes, 3.0F);
  EXPECT_EQ(cloud_of(bytes).points.at(0), Eigen::Vector3f(1, 2, 3));
}

TEST_F(PcdFile, BinaryIsReadWithEachTypeOfIntensity) {
  const auto read = [this](const char* type, const char* size, auto value) {
    std::string bytes = header("intensity x y z", std::string(size) + " 4 4 4",
                               std::string(type) + " F F F", 2, "binary");
    for (int i = 0; i < 2; ++i) {
      files::append(bytes, value);
      for (const float v : {1.0F, 2.0F, 3.0F}) files::append(bytes, v);
    }
    return cloud_of(bytes);
  };
  EXPECT_THAT(read("U", "1", std::uint8_t{200}).intensity, ElementsAre(200, 200));
  EXPECT_THAT(read("I", "2", std::int16_t{-3}).intensity, ElementsAre(-3, -3));
  EXPECT_THAT(read("U", "4", 70000U).intensity, ElementsAre(70000, 70000));
  EXPECT_THAT(read("F", "8", 0.5).intensity, ElementsAre(0.5F, 0.5F));
  EXPECT_EQ(read("I", "8", std::int64_t{5}).points.at(1), Eigen::Vector3f(1, 2, 3));
}

TEST_F(PcdFile, NonFinitePointsAreDroppedAndCounted) {
  const auto cloud = cloud_of(header("x y z intensity", "4 4 4 4", "F F F F", 4, "ascii") +
                              "1 2 3 10\nnan nan nan 20\n1 inf 3 30\n4 5 6 40\n");
  EXPECT_EQ(cloud.points.size(), 2U);
  EXPECT_THAT(cloud.intensity, ElementsAre(10, 40));
  EXPECT_EQ(cloud.invalid_points, 2U);
}

TEST_F(PcdFile, BinaryCompressedIsReadColumnByColumn) {
  constexpr std::size_t kPoints = 700;
  std::string columns;
  for (std::size_t i = 0; i < kPoints; ++i) files::append(columns, static_cast<float>(i % 50));
  for (std::size_t i = 0; i < kPoints; ++i) files::append(columns, static_cast<std::uint8_t>(i));
  for (std::size_t i = 0; i < kPoints; ++i) files::append(columns, -2.0F);
  for (std::size_t i = 0; i < kPoints; ++i) files::append(columns, static_cast<float>(3 * i));
  const std::string packed = lzf_pack(columns);
  ASSERT_LT(packed.size(), columns.size() / 2);
  std::string bytes = header("x intensity y z", "4 1 4 4", "F U F F", kPoints, "binary_compressed");
  files::append(bytes, static_cast<std::uint32_t>(packed.size()));
  files::append(bytes, static_cast<std::uint32_t>(columns.size()));
  const auto cloud = cloud_of(bytes + packed);
  ASSERT_EQ(cloud.points.size(), kPoints);
  for (const std::size_t i : {0U, 1U, 299U, 699U}) {
    EXPECT_EQ(cloud.points[i],
              Eigen::Vector3f(static_cast<float>(i % 50), -2, static_cast<float>(3 * i)));
    EXPECT_EQ(cloud.intensity[i], static_cast<float>(i % 256));
  }
  EXPECT_THAT(error_of(bytes + packed.substr(0, 100)), HasSubstr("ends early"));
  std::string damaged = packed;
  damaged[0] = '\x3f';  // a copy from before the start
  EXPECT_THAT(error_of(bytes + damaged), HasSubstr("the compressed data is damaged"));
}

TEST_F(PcdFile, LzfTokensAreUnpackedAsTheFormatSays) {
  std::string out;
  // Three literals, a copy of 5 from 3 back, a long copy of 9 from 1 back.
  const std::string packed(
      "\x02"
      "abc"
      "\x60\x02"
      "\xe0\x00\x00",
      9);
  ASSERT_TRUE(clouds::lzf_decompress(packed, 17, out));
  EXPECT_EQ(out, "abcabcabbbbbbbbbb");
  EXPECT_FALSE(clouds::lzf_decompress(packed, 16, out));
  EXPECT_FALSE(clouds::lzf_decompress(packed, 18, out));
  EXPECT_FALSE(clouds::lzf_decompress(packed.substr(0, 8), 17, out));
  EXPECT_FALSE(clouds::lzf_decompress("x", std::size_t{1} << 40, out));  // asks for no memory
}

TEST_F(PcdFile, FarCoordinatesKeepTheirMillimetresThroughAnOrigin) {
  std::string bytes = header("x y z", "8 8 8", "F F F", 3, "binary");
  const Eigen::Vector3d far(458123.1234, 5428123.4321, 116.5678);
  for (const double shift : {0.0, 0.001, 10.0}) {
    for (int axis = 0; axis < 3; ++axis) files::append(bytes, far[axis] + shift);
  }
  const auto cloud = cloud_of(bytes);
  EXPECT_EQ(cloud.origin, Eigen::Vector3d(458123, 5428123, 117));  // whole metres
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d expected =
        far + Eigen::Vector3d::Constant(std::array{0.0, 0.001, 10.0}[i]);
    const Eigen::Vector3d found = cloud.origin + cloud.points[i].cast<double>();
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 1e-6);  // a float near 10 m
  }
  const auto path = folder / "again.pcd";
  ASSERT_TRUE(write_cloud(path, cloud));
  EXPECT_THAT(read_bytes(path), HasSubstr("SIZE 8 8 8"));
  const auto again = read_cloud(path);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->origin, cloud.origin);
  EXPECT_EQ(again->points, cloud.points);
}

TEST_F(PcdFile, AStrayPointDoesNotMoveTheOrigin) {
  std::string text = header("x y z", "4 4 4", "F F F", 5, "ascii");
  text += "20000 0 0\n20001 1 0\n20002 2 0\n1e30 1e30 0\n1e300 0 0\n";
  const auto cloud = cloud_of(text);
  EXPECT_EQ(cloud.origin, Eigen::Vector3d(20002, 1, 0));
  EXPECT_EQ(cloud.points.size(), 4U);
  EXPECT_EQ(cloud.invalid_points, 1U);  // no float holds 1e300
}

TEST_F(PcdFile, CoordinatesNearTheOriginKeepEveryBit) {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    cloud.points.emplace_back(0.1F * static_cast<float>(i), -1e-7F, 9999.999F);
    cloud.intensity.push_back(0.3F * static_cast<float>(i));
  }
  const auto path = folder / "c.pcd";
  ASSERT_TRUE(write_cloud(path, cloud));
  const auto again = read_cloud(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->points, cloud.points);
  EXPECT_EQ(again->intensity, cloud.intensity);
  const auto bytes = read_bytes(path);
  ASSERT_TRUE(write_cloud(path, *again));
  EXPECT_EQ(read_bytes(path), bytes);
  EXPECT_THAT(folder.names(), ElementsAre("c.pcd"));
}

TEST_F(PcdFile, FilesThatEndEarlySayHowManyPointsAreThere) {
  std::string bytes =
      header("x y z", "4 4 4", "F F F", 10, "binary") + std::string(12 * 7 + 3, 'a');
  EXPECT_THAT(error_of(bytes),
              AllOf(HasSubstr("c.pcd: ends early"), HasSubstr("10 points"), HasSubstr("7 found")));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 3, "ascii") + "1 2 3\n"),
              HasSubstr("ends after 1 of 3 points"));
  EXPECT_THAT(error_of("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n"),
              HasSubstr("ends before the header's DATA line"));
  EXPECT_THAT(error_of(""), HasSubstr("ends before the header's DATA line"));
}

TEST_F(PcdFile, ErrorsNameTheFieldOrLineThatIsWrong) {
  EXPECT_THAT(error_of(header("x y", "4 4", "F F", 1, "ascii") + "1 2\n"),
              HasSubstr("has no field 'z'; its fields are x, y"));
  EXPECT_THAT(error_of(header("x y z", "4 2 4", "F I F", 1, "ascii") + "1 2 3\n"),
              HasSubstr("field 'y' is 1 x int16, expected one float32 or float64"));
  EXPECT_THAT(error_of(header("x y z", "4 8 4", "F F F", 1, "ascii") + "1 2 3\n"),
              HasSubstr("field 'y' is float64 but 'x' is float32"));
  EXPECT_THAT(error_of(header("x y z", "4 4 3", "F F F", 1, "ascii") + "1 2 3\n"),
              HasSubstr("field 'z' has TYPE F SIZE 3"));
  EXPECT_THAT(error_of(header("x y z", "4 4", "F F F", 1, "ascii") + "1 2 3\n"),
              HasSubstr("3 FIELDS but 2 SIZE"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii", "1 0 1") + "1 2 3\n"),
              HasSubstr("field 'y' has COUNT 0"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n1 2\n"),
              HasSubstr("line 12: 2 values, expected 3"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 three\n"),
              HasSubstr("line 11: 'three' is not a number"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "zipped") + "1 2 3\n"),
              HasSubstr("DATA is 'zipped', expected ascii, binary or binary_compressed"));
  EXPECT_THAT(error_of("solid stl\n"), HasSubstr("line 1: 'solid' is not a line of a PCD header"));
}

TEST_F(PcdFile, PointCountsThatContradictOrOverflowAreErrors) {
  const std::string start = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  EXPECT_THAT(error_of(start + "WIDTH 2\nHEIGHT 2\nPOINTS 5\nDATA binary\n"),
              HasSubstr("POINTS 5 but WIDTH 2 x HEIGHT 2"));
  EXPECT_THAT(error_of(start + "WIDTH 1000000000000\nHEIGHT 1000000000000\nDATA binary\n"),
              HasSubstr("is not a number of points"));
  EXPECT_THAT(error_of(start + "WIDTH -1\nDATA binary\n"), HasSubstr("WIDTH '-1'"));
  EXPECT_THAT(error_of(start + "DATA binary\n"), HasSubstr("no POINTS and no WIDTH"));
  EXPECT_THAT(error_of(start + "POINTS 1000000000000\nDATA binary\n"), HasSubstr("ends early"));
  EXPECT_THAT(error_of(start + "POINTS 1000000000000\nDATA ascii\n1 2 3\n"),
              HasSubstr("ends after 1 of"));
  EXPECT_EQ(cloud_of(start + "WIDTH 1\nDATA ascii\n1 2 3\n").points.size(), 1U);
}

TEST_F(PcdFile, ACloudWithoutAUsablePointIsAnError) {
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 1, "ascii") + "nan 2 3\n"),
              HasSubstr("holds no usable point (1 are not finite)"));
  EXPECT_THAT(error_of(header("x y z", "4 4 4", "F F F", 0, "binary")),
              HasSubstr("holds no usable point"));
}

TEST_F(PcdFile, OnlyKnownExtensionsAreReadAndWritten) {
  const auto read = read_cloud(folder.put("c.las", "x"));
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("c.las: extension '.las'"));
  EXPECT_THAT(read.error().message, HasSubstr("expected .pcd or .ply"));
  const auto written = write_cloud(folder / "c.xyz", PointCloud{});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("extension '.xyz'"));
  EXPECT_TRUE(
      read_cloud(folder.put("C.PCD", header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 3\n")));
  EXPECT_FALSE(read_cloud(folder / "none.pcd"));
}

}  // namespace
}  // namespace holdfast::io::testing
