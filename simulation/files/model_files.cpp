#include "simulation/files/model_files.hpp"

#include <algorithm>
#include <thread>

#include "holdfast/io/cloud_file.hpp"
#include "simulation/clouds/cloud_discs.hpp"
#include "simulation/meshes/mesh_file.hpp"

namespace holdfast::simulation {

using Eigen::Vector3d;
using Eigen::Vector3f;

std::filesystem::path ModelPlace::path(const std::string& scenario) const {
  return std::filesystem::path(scenario).parent_path() / file;
}

Eigen::Isometry3d ModelPlace::T_world_model() const {
  return Eigen::Translation3d(at) * Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Vector3d::UnitZ());
}

Status MeshPart::add_to(WorldBuilder& build, const std::string& scenario) const {
  const auto mesh = read_mesh(path(scenario));
  if (!mesh) return mesh.error();
  const Eigen::Isometry3d T_world_model = ModelPlace::T_world_model();
  const auto corner = [&](std::uint32_t i) -> Vector3d {
    const Vector3d p = scale * mesh->vertices[i].cast<double>();
    return T_world_model * (up == "z" ? p : Vector3d(p.x(), -p.z(), p.y()));
  };
  const Material surface = material_of(material);
  for (const auto& [i, j, k] : mesh->triangles) {
    if (sides != "back") build.triangle(corner(i), corner(j), corner(k), surface);
    if (sides != "front") build.triangle(corner(i), corner(k), corner(j), surface);
  }
  return Done{};
}

Status CloudPart::add_to(WorldBuilder& build, const std::string& scenario) const {
  const auto cloud = io::read_cloud(path(scenario));
  if (!cloud) return cloud.error();
  WorkerPool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  const CloudDiscs discs = discs_of(cloud->points, spacing, pool);
  const Eigen::Isometry3f T_world_model = ModelPlace::T_world_model().cast<float>();
  const auto add = [&](const std::vector<Disc>& list, const Material& material_there) {
    for (Disc disc : list) {
      disc.center = T_world_model * disc.center;
      disc.normal = T_world_model.linear() * disc.normal;
      build.disc(disc, material_there);
    }
  };
  add(discs.surfaces, material_of(material));
  add(discs.scattered, material_of(scattered));
  return Done{};
}

}  // namespace holdfast::simulation
