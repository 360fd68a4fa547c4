#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "holdfast/io/cloud_file.hpp"
#include "tests/io/clouds/cloud_bytes.hpp"
#include "tests/io/temporary_folder.hpp"

namespace holdfast::io::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kXyz = "property float x\nproperty float y\nproperty float z\n";

std::string header(std::string_view format, std::string_view body) {
  return "ply\nformat " + std::string(format) + " 1.0\ncomment made by hand\n" + std::string(body) +
         "end_header\n";
}

struct PlyFile : ::testing::Test {
  TemporaryFolder folder;

  PointCloud cloud_of(std::string_view bytes) {
    auto cloud = read_cloud(folder.put("c.ply", bytes));
    EXPECT_TRUE(cloud) << cloud.error().message;
    return cloud ? *cloud : PointCloud{};
  }
  std::string error_of(std::string_view bytes) {
    const auto cloud = read_cloud(folder.put("c.ply", bytes));
    EXPECT_FALSE(cloud);
    return cloud ? "" : cloud.error().message;
  }
};

TEST_F(PlyFile, AsciiIsReadWithOtherPropertiesAndFaces) {
  const auto cloud =
      cloud_of(header("ascii",
                      "element vertex 2\nproperty uchar red\nproperty double z\nproperty double x\n"
                      "property double y\nproperty ushort intensity\n"
                      "element face 1\nproperty list uchar int vertex_indices\n") +
               "255 3 1 2 700\n0 -6 4 5 8\n3 0 1 1\n");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, -6));
  EXPECT_THAT(cloud.intensity, ElementsAre(700, 8));
}

TEST_F(PlyFile, LittleAndBigEndianGiveTheSamePoints) {
  const std::string body = "element vertex 2\nproperty uint8 tag\n" + std::string(kXyz) +
                           "property int16 scalar_intensity\n";
  std::string little = header("binary_little_endian", body);
  std::string big = header("binary_big_endian", body);
  for (int i = 0; i < 2; ++i) {
    little.push_back('t');
    big.push_back('t');
    for (const float v : {1.5F, -2.25F, 1e4F}) {
      files::append(little, v);
      append_big_endian(big, v);
    }
    files::append(little, std::int16_t{-300});
    append_big_endian(big, std::int16_t{-300});
  }
  for (const auto& cloud : {cloud_of(little), cloud_of(big)}) {
    ASSERT_EQ(cloud.points.size(), 2U);
    EXPECT_EQ(cloud.points[1], Eigen::Vector3f(1.5F, -2.25F, 1e4F));
    EXPECT_THAT(cloud.intensity, ElementsAre(-300, -300));
  }
}

TEST_F(PlyFile, ElementsBeforeTheVerticesArePassedOver) {
  const std::string body =
      "element camera 2\nproperty float focal\nproperty list uchar ushort pixels\n"
      "element vertex 1\n" +
      std::string(kXyz);
  std::string bytes = header("binary_big_endian", body);
  append_big_endian(bytes, 50.0F);
  bytes.push_back(0);
  append_big_endian(bytes, 60.0F);
  bytes += std::string("\x02", 1) + "abcd";
  for (const float v : {1.0F, 2.0F, 3.0F}) append_big_endian(bytes, v);
  EXPECT_EQ(cloud_of(bytes).points.at(0), Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud_of(header("ascii", body) + "50 0\n60 2 7 8\n1 2 3\n").points.at(0),
            Eigen::Vector3f(1, 2, 3));
  EXPECT_THAT(error_of(header("binary_big_endian", body) + std::string(4, '\x7f') +
                       "\xff"
                       "ab"),
              HasSubstr("ends early: in element 'camera'"));
}

TEST_F(PlyFile, NonFiniteVerticesAreDroppedAndCounted) {
  const auto cloud = cloud_of(header("ascii", "element vertex 3\n" + std::string(kXyz)) +
                              "nan 0 0\n1 2 3\n0 -inf 0\n");
  EXPECT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.invalid_points, 2U);
}

TEST_F(PlyFile, WhatWasWrittenHasTheSameBitsWhenRead) {
  PointCloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.points.emplace_back(0.1F * static_cast<float>(i), 1e-20F, -7.7F);
  }
  const auto path = folder / "c.ply";
  ASSERT_TRUE(write_cloud(path, cloud));
  auto again = read_cloud(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->points, cloud.points);
  EXPECT_TRUE(again->intensity.empty());

  cloud.intensity.assign(500, 0.7F);
  cloud.origin = {500'000, 5'400'000, 100};
  ASSERT_TRUE(write_cloud(path, cloud));
  EXPECT_THAT(read_bytes(path), HasSubstr("property double x"));
  again = read_cloud(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->intensity, cloud.intensity);
  for (std::size_t i = 0; i < 500; ++i) {
    const Eigen::Vector3d difference = again->origin + again->points[i].cast<double>() -
                                       cloud.origin - cloud.points[i].cast<double>();
    EXPECT_LE(difference.lpNorm<Eigen::Infinity>(), 2e-6);  // half a float's step within 32 m
  }
  EXPECT_THAT(folder.names(), ElementsAre("c.ply"));
}

TEST_F(PlyFile, ErrorsNameWhatIsWrong) {
  const std::string vertex = "element vertex 2\n" + std::string(kXyz);
  EXPECT_THAT(error_of("plywood\n"), HasSubstr("c.ply: does not begin with 'ply'"));
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\n"), HasSubstr("ends before 'end_header'"));
  EXPECT_THAT(error_of(header("binary_middle_endian", vertex)),
              HasSubstr("line 2: 'format binary_middle_endian 1.0' is not a line of a PLY header"));
  EXPECT_THAT(error_of(header("ascii", "element vertex many\n")), HasSubstr("line 4"));
  EXPECT_THAT(error_of(header("ascii", "property float x\n")), HasSubstr("line 4"));
  EXPECT_THAT(error_of(header("ascii", "element vertex 1\nproperty real x\n")),
              HasSubstr("line 5"));
  EXPECT_THAT(error_of(header("ascii", "element face 0\nproperty list uchar int i\n")),
              HasSubstr("has no element 'vertex'"));
  EXPECT_THAT(error_of(header("ascii", "element vertex 1\nproperty float x\nproperty float y\n")),
              HasSubstr("has no field 'z'"));
  EXPECT_THAT(error_of(header("ascii", "element vertex 1\nproperty int x\nproperty float y\n")),
              HasSubstr("field 'x' is 1 x int32"));
  EXPECT_THAT(error_of(header("ascii", vertex + "property list uchar float path\n")),
              HasSubstr("property 'path' of the vertices is a list"));
  EXPECT_THAT(error_of(header("ascii", vertex) + "1 2 3\n"), HasSubstr("ends after 1 of 2"));
  EXPECT_THAT(error_of(header("ascii", vertex) + "1 2 3\n1 2 x\n"),
              HasSubstr("line 10: 'x' is not a number"));
  EXPECT_THAT(error_of(header("binary_little_endian", vertex) + std::string(20, 'a')),
              AllOf(HasSubstr("ends early"), HasSubstr("2 vertices"), HasSubstr("1 found")));
}

}  // namespace
}  // namespace holdfast::io::testing
