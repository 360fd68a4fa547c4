#include "simulation/files/world_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/files/model_files.hpp"
#include "simulation/meshes/mesh_file.hpp"
#include "simulation/wayfinding/found_route.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kLongestDrive = 300;  // metres, unless a duration is given

}  // namespace

bool is_world_file(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".pcd" || ending == ".ply" || ending == ".obj";
}

Result<Scenario> read_world_file(const std::filesystem::path& path) {
  WorldBuilder build;
  const std::string ending = path.extension().string();
  Status added = Done{};
  if (ending == ".obj" || (ending == ".ply" && has_faces(path))) {
    MeshPart mesh;
    mesh.file = path.string();
    added = mesh.add_to(build, "");
  } else {
    CloudPart cloud;
    cloud.file = path.string();
    added = cloud.add_to(build, "");
  }
  if (!added) return added.error();
  Scenario scenario;
  scenario.name = path.stem().string();
  scenario.world = build.build();
  if (auto found = find_way(scenario); !found) {
    return Error{fmt::format("{}: {}", path.string(), found.error().message)};
  }
  return scenario;
}

Status find_way(Scenario& scenario) {
  auto found = find_route(scenario.world);
  if (!found) return found.error();
  scenario.route = std::move(found->route);
  scenario.style.distance_m = std::clamp(std::floor(found->length_m), 1.0, kLongestDrive);
  scenario.remark = fmt::format(
      "the way found through this world is {:.0f} m long, closed; {:.0f} % of it goes back as it "
      "came{}",
      found->length_m, 100 * found->shared_share,
      found->on_ground ? "" : "; there is no ground: it is as high as the lowest things around");
  return Done{};
}

}  // namespace holdfast::simulation
