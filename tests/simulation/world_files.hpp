#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "simulation/world/ray_caster.hpp"

/// Worlds in files of their own, for tests.
namespace holdfast::simulation::testing {

/// A folder that is gone with the test.
class WorldFolder {
 public:
  WorldFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "world_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~WorldFolder() { std::filesystem::remove_all(path_); }
  WorldFolder(const WorldFolder&) = delete;
  WorldFolder& operator=(const WorldFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

  /// world.yaml with these parts, and a route of 44 m on the ground.
  std::filesystem::path scenario(const std::string& parts) const {
    return write("world.yaml", "name: test\nworld:\n" + parts +
                                   "\nroute:\n  radius_m: 1.5\n"
                                   "  corners: [[2, 2], [18, 2], [18, 8], [2, 8]]\n");
  }

 private:
  std::filesystem::path path_;
};

/// First hit of one ray; the range is infinite where nothing was met.
inline HitPacket cast_one(const RayCaster& caster, const Eigen::Vector3d& origin,
                          const Eigen::Vector3d& direction) {
  RayPacket rays;
  const Eigen::Vector3f o = origin.cast<float>();
  const Eigen::Vector3f d = direction.normalized().cast<float>();
  rays.x.fill(o.x());
  rays.y.fill(o.y());
  rays.z.fill(o.z());
  rays.dx.fill(d.x());
  rays.dy.fill(d.y());
  rays.dz.fill(d.z());
  HitPacket hits;
  caster.cast(rays, 0, 1000, hits);
  return hits;
}

/// Metres down to the first surface.
inline double casts_down(const RayCaster& caster, const Eigen::Vector3d& from) {
  return cast_one(caster, from, -Eigen::Vector3d::UnitZ()).range[0];
}

/// The folder of public recordings and maps, where they are installed.
inline std::filesystem::path data_folder() {
  if (const char* folder = std::getenv("HOLDFAST_DATA")) return folder;
  const auto repository = std::filesystem::path(__FILE__).parent_path().parent_path().parent_path();
  return repository.parent_path() / "shared" / "data";
}

}  // namespace holdfast::simulation::testing
