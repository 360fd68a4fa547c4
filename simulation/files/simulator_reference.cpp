#include "simulation/files/simulator_reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "holdfast/io/config_io.hpp"
#include "simulation/events/event_reference.hpp"
#include "simulation/files/fault_reference.hpp"
#include "simulation/files/part_files.hpp"
#include "simulation/scenario.hpp"
#include "simulation/sensors/imu/imu_file.hpp"
#include "simulation/sensors/lidar/lidar_file.hpp"

namespace holdfast::simulation {
namespace {

constexpr std::string_view kWorlds = R"(# The simulator's files

`holdfast simulate FILE.yaml --out DIR` drives through a world that a file describes:

```yaml
name: shed
world:
  - floor: {min: [0, 0], max: [20, 10]}
  - wall: {from: [0, 0], to: [20, 0], top: 4, openings: [{start: 3, width: 1.2}]}
  - repeat:
      times: 4
      step: [4, 0, 0]
      parts:
        - cylinder: {base: [4, 5, 0], radius: 0.25, height: 4}
route:
  radius_m: 1.5
  corners: [[2, 2], [18, 2], [18, 8], [2, 8]]
drive: {speed_m_s: 1.5}
```

Lengths are metres, z is up, and walls are seen from the left of the way from their first
foot to their second. [garage.yaml](../simulation/scenarios/garage.yaml) and
[campus.yaml](../simulation/scenarios/campus.yaml) are whole ones.

- A route is closed; its corners are `[x, y]`, `[x, y, z]` or `[x, y, z, radius_m]`.
  `route: auto` finds a way: from one end of the drivable ground to the other, and back
  another way where there is one.
- `people` is a list of a `route` and a `speed_m_s` each, `vehicles` likewise with a `kind`
  (car, van, bus); they keep to the direction of their routes. Who walks or drives waits
  where the robot comes near.
- `groups` are people who now and then come to the robot and stand by it or go with it.
- Where a corner of the robot's route stands straight above the one before, a lift takes the
  robot there; `lifts` says what it looks like ([lift.yaml](../simulation/scenarios/lift.yaml)).
  Who surveys a world takes the stairs: the map shows closed landing doors, and no cabin.
- `regions` names stretches of the way: a list of a `name` and a rectangle, `min` and `max`.

A mesh or a cloud can be a world, too. Files of a `mesh` or a `cloud` are looked up beside the
scenario file; coordinates of a cloud that begin beyond 10 km count from the cloud's own
origin. A whole scenario can be

```yaml
name: ours
world:
  - cloud: {file: ../data/map.pcd}
route: auto
```

which is what `holdfast simulate ../data/map.pcd` does (or with a .ply or .obj).

)";

constexpr std::string_view kLidars = R"(# LiDAR files

`--lidar FILE.yaml` takes a LiDAR from a file; `--lidar NAME` one of {}.
The block `faults` says what it does wrong, by default nothing; `--faults lidar` gives any
LiDAR the usual sizes. Rain and dust (`--rain`, `--visibility`) are none of the sensor's:
they weaken returns, which limits the reach, and return some light themselves.

)";

/// The keys of a block with its defaults.
template <class Block>
std::string keys_of(const char* name) {
  Block block;
  std::vector<io::FieldRef> fields;
  io::collect_fields(name, block, fields);
  return io::config_reference(fields);
}

}  // namespace

std::string simulator_reference() {
  const std::string keys = keys_of<DriveStyle>("drive") + "\n" + keys_of<GroupPlan>("groups") +
                           "\n" + keys_of<LiftPlan>("lifts") + "\n" + keys_of<Region>("regions");
  const std::string lidars =
      fmt::format(fmt::runtime(kLidars), fmt::join(lidar_names(), ", ")) + lidar_reference();
  return std::string(kWorlds) + keys + "\n## Parts of the world\n\n" + part_reference() +
         event_reference() + lidars + "\n" + imu_reference() + "\n" + fault_reference();
}

}  // namespace holdfast::simulation
