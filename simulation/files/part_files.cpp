#include "simulation/files/part_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "holdfast/io/yaml_block.hpp"
#include "simulation/buildings/plain_house.hpp"
#include "simulation/buildings/tunnel.hpp"
#include "simulation/files/model_files.hpp"
#include "simulation/files/storage.hpp"

namespace holdfast::simulation {
namespace {

using Fields = std::vector<io::FieldRef>;

Error at(const std::string& file, const YAML::Node& node, const std::string& message) {
  return {fmt::format("{}:{}: {}", file, node.Mark().line + 1, message)};
}

/// `block` without keys that are no fields.
YAML::Node without(const YAML::Node& block, std::initializer_list<std::string_view> keys) {
  if (!block.IsMap()) return block;
  YAML::Node rest(YAML::NodeType::Map);
  for (const auto& entry : block) {
    const bool left_out = entry.first.IsScalar() &&
                          std::find(keys.begin(), keys.end(), entry.first.Scalar()) != keys.end();
    if (!left_out) rest[entry.first] = entry.second;
  }
  return rest;
}

template <class Part>
Status read_part(const YAML::Node& block, const std::string& place, const std::string& file,
                 Part& part) {
  Fields fields;
  io::collect_fields("", part, fields);
  if (auto read = io::read_block(block, file, fields); !read) return read;
  return io::check_required(place, fields);
}

/// The list below `parts`, or nothing.
YAML::Node parts_of(const YAML::Node& block) {
  const YAML::Node& fixed = block;
  return fixed["parts"] ? fixed["parts"] : YAML::Node(YAML::NodeType::Null);
}

std::string place_of(const std::string& file, const YAML::Node& node) {
  return fmt::format("{}:{}", file, node.Mark().line + 1);
}

template <class Part>
Status build_part(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  Part part;
  if (auto read = read_part(block, place_of(file, block), file, part); !read) return read;
  part.add_to(build);
  return Done{};
}

template <class Part>
std::string keys_of(std::string_view name) {
  Part part;
  Fields fields;
  io::collect_fields(std::string(name), part, fields);
  return io::config_reference(fields);
}

/// The list below `key`, or nothing.
Result<YAML::Node> list_below(const YAML::Node& block, const char* key, const std::string& file) {
  const YAML::Node list = block.IsMap() ? block[key] : YAML::Node();
  if (list.IsDefined() && !list.IsNull() && !list.IsSequence()) {
    return at(file, list,
              fmt::format("{}: expected a list, found {}", key, io::describe_node(list)));
  }
  return list;
}

Status build_wall(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  WallPart wall;
  const std::string place = place_of(file, block);
  if (auto read = read_part(without(block, {"openings"}), place, file, wall); !read) return read;
  const auto openings = list_below(block, "openings", file);
  if (!openings) return openings.error();
  for (const YAML::Node& node : *openings) {
    OpeningPart hole;
    if (auto read = read_part(node, place_of(file, node), file, hole); !read) return read;
    hole.opening.back = material_of(hole.back);
    wall.plan.openings.push_back(hole.opening);
  }
  wall.add_to(build);
  return Done{};
}

Status build_tunnel(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  Tunnel tunnel;
  const std::string place = place_of(file, block);
  if (auto read = read_part(without(block, {"recesses"}), place, file, tunnel); !read) return read;
  const auto recesses = list_below(block, "recesses", file);
  if (!recesses) return recesses.error();
  for (const YAML::Node& node : *recesses) {
    TunnelRecess recess;
    if (auto read = read_part(node, place_of(file, node), file, recess); !read) return read;
    tunnel.recesses.push_back(recess);
  }
  tunnel.add_to(build);
  return Done{};
}

/// A list below `parts`, so many times, each time a step on.
struct RepeatPart {
  int times = 2;
  Eigen::Vector3d step{1, 0, 0};
  bool has_times = false, has_step = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("times", self.times, FieldDoc{"how often `parts` are built", 1, 10000}, &self.has_times);
    visit("step", self.step, FieldDoc{"from one to the next, x y z"}, &self.has_step);
  }
};

Status build_repeat(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  RepeatPart repeat;
  const std::string place = place_of(file, block);
  if (auto read = read_part(without(block, {"parts"}), place, file, repeat); !read) return read;
  Status status = Done{};
  for (int i = 0; i < repeat.times && status; ++i) {
    build.moved(i * repeat.step, [&] { status = build_parts(parts_of(block), file, build); });
  }
  return status;
}

struct MovedPart {
  Eigen::Vector3d by{0, 0, 0};
  bool has_by = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("by", self.by, FieldDoc{"x y z"}, &self.has_by);
  }
};

Status build_moved(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  MovedPart moved;
  const std::string place = place_of(file, block);
  if (auto read = read_part(without(block, {"parts"}), place, file, moved); !read) return read;
  Status status = Done{};
  build.moved(moved.by, [&] { status = build_parts(parts_of(block), file, build); });
  return status;
}

struct ObjectPart {
  WorldObject object;
  bool has_name = false;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("name", self.object.name, FieldDoc{"what it is"}, &self.has_name);
    visit("mounted", self.object.mounted,
          FieldDoc{"it comes and goes, but does not wander, in a changed world"});
  }
};

Status build_object(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  ObjectPart part;
  const std::string place = place_of(file, block);
  if (auto read = read_part(without(block, {"parts"}), place, file, part); !read) return read;
  Status status = Done{};
  build.object(part.object, [&] { status = build_parts(parts_of(block), file, build); });
  return status;
}

Status build_spare(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  Status status = Done{};
  build.spare([&] { status = build_parts(block, file, build); });
  return status;
}

/// What stands in a file of its own.
template <class Part>
Status build_model(const YAML::Node& block, const std::string& file, WorldBuilder& build) {
  Part part;
  const std::string place = place_of(file, block);
  if (auto read = read_part(block, place, file, part); !read) return read;
  const Status added = part.add_to(build, file);
  return added ? added : at(file, block, added.error().message);
}

struct PartKind {
  std::string_view name;
  std::string_view summary;
  Status (*build)(const YAML::Node&, const std::string&, WorldBuilder&);
  std::string (*keys)(std::string_view name);  ///< none: a list of parts
};

template <class Part>
constexpr PartKind kind(std::string_view name, std::string_view summary) {
  return {name, summary, build_part<Part>, keys_of<Part>};
}

constexpr std::array kParts = {
    kind<FloorPart>("floor", "floor or ground over a rectangle, seen from above"),
    kind<CeilingPart>("ceiling", "the same seen from below"),
    PartKind{"wall", "upright wall; `openings` is a list of doors, niches, windows, passages",
             build_wall, keys_of<WallPart>},
    kind<BoxPart>("box", "solid box that stands or floats"),
    kind<RampPart>("ramp", "flat ground that rises"),
    kind<CylinderPart>("cylinder", "solid upright cylinder"),
    kind<DeskPart>("desk", "desk with a monitor, 1.4 x 0.75 m"),
    kind<ChairPart>("chair", "office chair"),
    kind<PlainChairPart>("plain_chair", "wooden chair"),
    kind<TablePart>("table", "table on four legs, 0.9 m wide"),
    kind<ShelfPart>("shelf", "open shelf with folders"),
    kind<CabinetPart>("cabinet", "closed cabinet"),
    kind<PartitionPart>("partition", "upright panel"),
    kind<PlantPart>("plant", "pot with a bush"),
    kind<CratePart>("crate", "something closed that was put down"),
    kind<BenchPart>("bench", "bench without a back"),
    kind<WallBoxPart>("wall_box", "flat thing on a wall; `at` lies on the wall, +x points off it"),
    kind<TreePart>("tree", "deciduous tree"),
    kind<PolePart>("pole", "lamp post or sign"),
    kind<CarPart>("car", "parked car, 4.4 m long"),
    kind<HousePart>("house", "house with windows, doors and pillars on all sides"),
    kind<PlainHouse>("plain_house", "house of brick with two rows of windows on all sides"),
    PartKind{"tunnel", "vaulted road tunnel with a bend; `recesses` is a list of doors and niches",
             build_tunnel, keys_of<Tunnel>},
    kind<RackPart>("rack", "pallet rack with loads, along y before it is turned"),
    PartKind{"mesh", "triangles of a .ply or .obj file", build_model<MeshPart>, keys_of<MeshPart>},
    PartKind{"cloud", "points of a .pcd or .ply file, as discs that close its surfaces",
             build_model<CloudPart>, keys_of<CloudPart>},
    PartKind{"repeat", "builds the list in `parts` several times", build_repeat,
             keys_of<RepeatPart>},
    PartKind{"moved", "builds the list in `parts` elsewhere, as on another floor", build_moved,
             keys_of<MovedPart>},
    PartKind{"object", "the list in `parts` is one object, which a changed world may move or lack",
             build_object, keys_of<ObjectPart>},
    PartKind{"spare", "parts that are not there unless a changed world brings them", build_spare,
             nullptr},
};

Status build_one(const YAML::Node& entry, const std::string& file, WorldBuilder& build) {
  if (!entry.IsMap() || entry.size() != 1) {
    return at(file, entry,
              fmt::format("expected a part and its keys, as in `- box: {{...}}`, found {}",
                          io::describe_node(entry)));
  }
  const auto part = *entry.begin();
  std::string known;
  for (const PartKind& kind : kParts) {
    if (part.first.IsScalar() && part.first.Scalar() == kind.name) {
      return kind.build(part.second, file, build);
    }
    known += fmt::format("{}{}", known.empty() ? "" : ", ", kind.name);
  }
  return at(file, part.first,
            fmt::format("unknown part {}; known are: {}", io::describe_node(part.first), known));
}

}  // namespace

Status build_parts(const YAML::Node& list, const std::string& file, WorldBuilder& build) {
  if (!list.IsSequence()) {
    return at(file, list,
              fmt::format("expected a list of parts, found {}", io::describe_node(list)));
  }
  for (const YAML::Node& entry : list) {
    if (auto built = build_one(entry, file, build); !built) return built;
  }
  return Done{};
}

std::string part_reference() {
  std::string list;
  std::string keys;
  for (const PartKind& kind : kParts) {
    list += fmt::format("- `{}`: {}\n", kind.name, kind.summary);
    if (kind.keys != nullptr) keys += kind.keys(kind.name) + "\n";
    if (kind.name == "tunnel") keys += keys_of<TunnelRecess>("recesses of a tunnel") + "\n";
    if (kind.name == "wall") keys += keys_of<OpeningPart>("openings of a wall") + "\n";
  }
  return list + "\n" + keys;
}

}  // namespace holdfast::simulation
