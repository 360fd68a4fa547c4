#include "simulation/scenarios/all.hpp"
#include "simulation/world/world_builder.hpp"

namespace holdfast::simulation {

// One corner of the room is the origin of the map; every distance has a closed form.
Scenario make_box() {
  WorldBuilder build;
  const Eigen::Vector3d size(12, 8, 4);
  const Material& m = materials::kIdeal;
  build.floor({0, 0}, {size.x(), size.y()}, 0, m);
  build.ceiling({0, 0}, {size.x(), size.y()}, size.z(), m);
  build.wall({{0, 0}, {size.x(), 0}, 0, size.z(), m, {}});
  build.wall({{size.x(), 0}, {size.x(), size.y()}, 0, size.z(), m, {}});
  build.wall({{size.x(), size.y()}, {0, size.y()}, 0, size.z(), m, {}});
  build.wall({{0, size.y()}, {0, 0}, 0, size.z(), m, {}});

  Scenario scenario;
  scenario.name = "box";
  scenario.world = build.build();
  scenario.route = Route::closed({{2.5, 2}, {9.5, 2}, {9.5, 6}, {2.5, 6}}, 1.5);
  scenario.style.distance_m = 30;
  return scenario;
}

}  // namespace holdfast::simulation
