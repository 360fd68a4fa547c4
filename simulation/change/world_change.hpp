#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/core/result.hpp"
#include "simulation/scenario.hpp"

namespace holdfast::simulation {

/// What became of an object between the survey and the drive.
enum class ChangeKind {
  kMoved,    ///< stands elsewhere: up to 2.5 m away, turned by up to 35 degrees
  kRemoved,  ///< in the survey only
  kAdded,    ///< in the drive only
};

struct ObjectChange {
  std::size_t object = 0;  ///< index into World::objects
  ChangeKind kind = ChangeKind::kMoved;
};

/// A world at two times.
struct ChangedWorld {
  World before;                       ///< as the survey found it
  World after;                        ///< as the drive finds it
  std::vector<ObjectChange> changes;  ///< in the order of objects
};

/// The scenario's world without its spare objects: nothing has changed.
World unchanged_world(const World& world);

/// Changes `share` (0 to 1) of the world's objects, rounded to whole ones, spare ones included.
/// Which, and what becomes of them, depends on the seed: a third each is moved, removed and added;
/// mounted objects are not moved; spare ones can only be added. What is moved keeps off walls,
/// other objects and the ways of robot and people; what finds no place is removed. Triangles that
/// are in both worlds keep their order. Error: there are no objects to change.
Result<ChangedWorld> change_world(const Scenario& scenario, double share, std::uint64_t seed);

}  // namespace holdfast::simulation
