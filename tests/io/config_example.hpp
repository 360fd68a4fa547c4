#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/config_io.hpp"

/// A configuration with one field of each type, and a file in a folder of the running test.
namespace holdfast::io::testing {

struct FilterConfig {
  double range_sigma_m = 0.02;
  int iterations = 4;
  bool use_rings = true;
  std::string loss = "huber";
  std::vector<double> voxels_m = {0.5, 1.0};

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_sigma_m", self.range_sigma_m, FieldDoc{"noise of a range", 0.001, 1.0});
    visit("iterations", self.iterations, FieldDoc{"updates a scan", 1, 20});
    visit("use_rings", self.use_rings, FieldDoc{"whether rings are used"});
    visit("loss", self.loss, FieldDoc{.text = "robust loss", .choices = "none|huber|cauchy"});
    visit("voxels_m", self.voxels_m, FieldDoc{"sizes of voxels", 0.05, 10.0});
  }
};

struct DeskewConfig {
  double max_gap_s = 0.05;
  std::string topic;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_gap_s", self.max_gap_s, FieldDoc{"longest IMU gap bridged", 0.0});
    visit("topic", self.topic, FieldDoc{"any text"});
  }
};

struct ExampleConfig {
  SE3 T_body_lidar;
  bool has_extrinsic = false;
  FilterConfig filter;
  DeskewConfig deskew;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("T_body_lidar", self.T_body_lidar, FieldDoc{"lidar in the body frame"},
          &self.has_extrinsic);
  }
};

inline std::vector<FieldRef> fields_of(ExampleConfig& config) {
  std::vector<FieldRef> fields;
  collect_fields("", config, fields);
  collect_fields("filter", config.filter, fields);
  collect_fields("deskew", config.deskew, fields);
  return fields;
}

/// A file with `text` that lives as long as this object; processes and tests never share one.
class ExampleFile {
 public:
  explicit ExampleFile(std::string_view text) {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(::testing::TempDir()) /
            ("holdfast_" + std::to_string(getpid()) + "_" + info->test_suite_name() + "_" +
             info->name() + ".yaml");
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~ExampleFile() { std::filesystem::remove(path_); }
  ExampleFile(const ExampleFile&) = delete;
  ExampleFile& operator=(const ExampleFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The message of reading `text` without the folder of the file; empty when it was read.
inline std::string reading_error(std::string_view text) {
  ExampleConfig config;
  auto fields = fields_of(config);
  const ExampleFile file(text);
  const Status status = read_config_file(file.path(), fields);
  if (status) return "";
  std::string message = status.error().message;
  const std::string full = file.path().string();
  if (message.starts_with(full)) message.replace(0, full.size(), "FILE");
  return message;
}

}  // namespace holdfast::io::testing
