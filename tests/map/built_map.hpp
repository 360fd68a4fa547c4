#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "holdfast/map/map_builder.hpp"
#include "holdfast/map/prior_map.hpp"

namespace holdfast::map::testing {

/// A new, empty folder with a name of its own; removed with what is in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "holdfast_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A map made of a cloud in a folder of its own, as `holdfast map import` makes it.
class BuiltMap {
 public:
  explicit BuiltMap(MapSource source, int threads = 1) {
    WorkerPool pool(threads);
    auto built = build_map(std::move(source), path(), pool);
    if (built) {
      info_ = *built;
    } else {
      ADD_FAILURE() << built.error().message;
    }
  }
  explicit BuiltMap(io::PointCloud cloud, int threads = 1)
      : BuiltMap(MapSource{std::move(cloud), std::nullopt, "test"}, threads) {}

  std::filesystem::path path() const { return folder_.path() / "map"; }
  const MapInfo& info() const { return info_; }

  PriorMap open() const {
    auto map = PriorMap::open(path());
    if (map) return std::move(*map);
    ADD_FAILURE() << map.error().message;
    std::abort();
  }

 private:
  ScratchFolder folder_;
  MapInfo info_;
};

}  // namespace holdfast::map::testing
