#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "holdfast/places/place_maker.hpp"
#include "holdfast/places/places.hpp"
#include "tests/map/built_map.hpp"
#include "tests/map/clouds.hpp"

namespace holdfast::places::testing {

using Eigen::Vector3d;
using map::testing::add_patch;

/// A map with its places in a folder of its own, as `holdfast map import` makes it.
class PlacedMap {
 public:
  explicit PlacedMap(io::PointCloud cloud, int threads = 1) {
    WorkerPool pool(threads);
    const auto built = build_map({std::move(cloud), std::nullopt, "test"}, path(), pool);
    if (!built) ADD_FAILURE() << built.error().message;
  }

  std::filesystem::path path() const { return folder_.path() / "map"; }
  std::filesystem::path file() const { return path() / "places.bin"; }
  std::string bytes() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  Places open() const {
    auto places = Places::open(path());
    if (places) return std::move(*places);
    ADD_FAILURE() << places.error().message;
    std::abort();
  }

 private:
  map::testing::ScratchFolder folder_;
};

/// Floor, ceiling and the walls that are asked for, of a room from `low` to `high`.
inline void add_room(const Vector3d& low, const Vector3d& high, bool end_walls,
                     RandomStream& random, io::PointCloud& cloud) {
  const Vector3d size = high - low;
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  add_patch(low, x, y, random, cloud.points);
  add_patch(low + z, x, y, random, cloud.points);
  add_patch(low, x, z, random, cloud.points);
  add_patch(low + y, x, z, random, cloud.points);
  if (!end_walls) return;
  add_patch(low, y, z, random, cloud.points);
  add_patch(low + x, y, z, random, cloud.points);
}

inline io::PointCloud room(const Vector3d& low, const Vector3d& high, bool end_walls = true) {
  RandomStream random(1, "room");
  io::PointCloud cloud;
  add_room(low, high, end_walls, random, cloud);
  return cloud;
}

}  // namespace holdfast::places::testing
