#include "simulation/files/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "holdfast/io/yaml_block.hpp"
#include "simulation/files/part_files.hpp"
#include "simulation/files/world_file.hpp"

namespace holdfast::simulation {
namespace {

using Fields = std::vector<io::FieldRef>;

constexpr std::size_t kFewestCorners = 3;

/// One document, block by block.
class ScenarioReader {
 public:
  explicit ScenarioReader(std::string file) : file_(std::move(file)) {}

  Result<Scenario> read(const YAML::Node& document) {
    if (!document.IsMap()) return expected(document, "a block of keys");
    const auto keys = check_keys(document, {"name", "summary", "world", "route", "drive", "people",
                                            "groups", "vehicles", "lifts", "regions"});
    if (!keys) return keys.error();
    for (const char* key : {"world", "route"}) {
      if (!document[key]) return Error{fmt::format("{}: missing: '{}'", file_, key)};
    }
    Scenario scenario;
    scenario.name = document["name"].as<std::string>("scenario");
    WorldBuilder build;
    if (auto built = build_parts(document["world"], file_, build); !built) return built.error();
    scenario.world = build.build();
    if (auto way = read_way(document["route"], scenario); !way) return way.error();
    if (document["drive"]) {
      if (auto drive = read_block(document["drive"], scenario.style); !drive) return drive.error();
    }
    auto people = read_people(document["people"]);
    if (!people) return people.error();
    scenario.walkers = std::move(*people);
    if (document["groups"]) {
      if (auto groups = read_block(document["groups"], scenario.groups); !groups) {
        return groups.error();
      }
    }
    auto vehicles = read_vehicles(document["vehicles"]);
    if (!vehicles) return vehicles.error();
    scenario.vehicles = std::move(*vehicles);
    auto lifts = read_list<LiftPlan>(document["lifts"], "a list of lifts");
    if (!lifts) return lifts.error();
    scenario.lifts = std::move(*lifts);
    auto regions = read_list<Region>(document["regions"], "a list of regions");
    if (!regions) return regions.error();
    scenario.regions = std::move(*regions);
    return scenario;
  }

 private:
  Error at(const YAML::Node& node, const std::string& message) const {
    return {fmt::format("{}:{}: {}", file_, node.Mark().line + 1, message)};
  }
  Error expected(const YAML::Node& node, std::string_view what) const {
    return at(node, fmt::format("expected {}, found {}", what, io::describe_node(node)));
  }

  Status check_keys(const YAML::Node& block, std::initializer_list<std::string_view> known) const {
    for (const auto& entry : block) {
      const std::string key = entry.first.as<std::string>("");
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        return at(entry.first,
                  fmt::format("unknown key '{}'; known are: {}", key, fmt::join(known, ", ")));
      }
    }
    return Done{};
  }

  template <class Part>
  Status read_block(const YAML::Node& block, Part& part) const {
    Fields fields;
    io::collect_fields("", part, fields);
    return io::read_block(block, file_, fields);
  }

  Result<RouteCorner> read_corner(const YAML::Node& node, double radius_m) const {
    constexpr std::string_view kForms = "[x, y], [x, y, z] or [x, y, z, radius_m]";
    if (!node.IsSequence() || node.size() < 2 || node.size() > 4) return expected(node, kForms);
    std::array<double, 4> v = {0, 0, 0, radius_m};
    for (std::size_t i = 0; i < node.size(); ++i) {
      const auto value = node[i].IsScalar() ? node[i].as<double>(NAN) : NAN;
      if (!std::isfinite(value)) return expected(node[i], "a number");
      v[i] = value;
    }
    if (v[3] <= 0) return expected(node[3], "a radius > 0");
    return RouteCorner{{v[0], v[1], v[2]}, v[3]};
  }

  /// The robot's route: laid out, or to be found in the world.
  Status read_way(const YAML::Node& node, Scenario& scenario) const {
    if (node.IsScalar() && node.Scalar() == "auto") {
      const Status found = find_way(scenario);
      return found ? found : at(node, found.error().message);
    }
    auto route = read_route(node);
    if (!route) return route.error();
    scenario.route = std::move(*route);
    return Done{};
  }

  Result<Route> read_route(const YAML::Node& block) const {
    if (!block || !block.IsMap()) return expected(block, "a route: corners and radius_m, or auto");
    if (auto keys = check_keys(block, {"corners", "radius_m"}); !keys) return keys.error();
    const double radius_m = block["radius_m"].as<double>(1.0);
    const YAML::Node list = block["corners"];
    if (!list || !list.IsSequence() || list.size() < kFewestCorners) {
      return at(block, "corners: expected a list of at least three");
    }
    std::vector<RouteCorner> corners;
    for (const YAML::Node& node : list) {
      const auto corner = read_corner(node, radius_m);
      if (!corner) return corner.error();
      const bool same =
          !corners.empty() && (corners.back().position - corner->position).head<2>().norm() < 1e-6;
      if (same) {
        const double rise_m = corner->position.z() - corners.back().position.z();
        if (rise_m == 0) return at(node, "the corner stands where the one before does");
        corners.back().ride_m = rise_m;
        continue;
      }
      corners.push_back(*corner);
    }
    return Route::closed(corners);
  }

  Result<std::vector<WalkerPlan>> read_people(const YAML::Node& list) const {
    std::vector<WalkerPlan> people;
    if (!list) return people;
    if (!list.IsSequence()) return expected(list, "a list of people");
    for (const YAML::Node& node : list) {
      if (!node.IsMap()) return expected(node, "a route and a speed_m_s");
      if (auto keys = check_keys(node, {"route", "speed_m_s"}); !keys) return keys.error();
      auto route = read_route(node["route"]);
      if (!route) return route.error();
      const double speed_m_s = node["speed_m_s"].as<double>(WalkerPlan{*route}.speed_m_s);
      if (!(speed_m_s > 0 && speed_m_s <= 10)) return expected(node["speed_m_s"], "0 to 10");
      people.push_back({std::move(*route), speed_m_s});
    }
    return people;
  }

  Result<std::vector<VehiclePlan>> read_vehicles(const YAML::Node& list) const {
    std::vector<VehiclePlan> vehicles;
    if (!list) return vehicles;
    if (!list.IsSequence()) return expected(list, "a list of vehicles");
    for (const YAML::Node& node : list) {
      if (!node.IsMap()) return expected(node, "a route, a speed_m_s and a kind");
      if (auto keys = check_keys(node, {"route", "speed_m_s", "kind"}); !keys) return keys.error();
      auto route = read_route(node["route"]);
      if (!route) return route.error();
      const double speed_m_s = node["speed_m_s"].as<double>(VehiclePlan{*route}.speed_m_s);
      if (!(speed_m_s > 0 && speed_m_s <= 40)) return expected(node["speed_m_s"], "0 to 40");
      const auto kind = read_kind(node["kind"]);
      if (!kind) return kind.error();
      vehicles.push_back({std::move(*route), speed_m_s, *kind});
    }
    return vehicles;
  }

  template <class Entry>
  Result<std::vector<Entry>> read_list(const YAML::Node& list, std::string_view what) const {
    std::vector<Entry> entries;
    if (!list) return entries;
    if (!list.IsSequence()) return expected(list, what);
    for (const YAML::Node& node : list) {
      Entry entry;
      Fields fields;
      io::collect_fields("", entry, fields);
      if (auto read = io::read_block(node, file_, fields); !read) return read.error();
      const std::string place = fmt::format("{}:{}", file_, node.Mark().line + 1);
      if (auto all = io::check_required(place, fields); !all) return all.error();
      entries.push_back(std::move(entry));
    }
    return entries;
  }

  Result<VehicleKind> read_kind(const YAML::Node& node) const {
    if (!node) return VehicleKind::kCar;
    const std::string name = node.as<std::string>("");
    for (const VehicleKind kind : kAllVehicleKinds) {
      if (name == vehicle_name(kind)) return kind;
    }
    return expected(node, "car, van or bus");
  }

  std::string file_;
};

Result<Scenario> scenario_of(const Result<YAML::Node>& document, const std::string& file) {
  if (!document) return document.error();
  try {
    return ScenarioReader(file).read(*document);
  } catch (const YAML::Exception& e) {
    return Error{fmt::format("{}:{}: {}", file, e.mark.line + 1, e.msg)};
  }
}

}  // namespace

Result<Scenario> read_scenario_file(const std::filesystem::path& path) {
  return scenario_of(io::load_yaml(path), path.string());
}

Result<Scenario> parse_scenario(const std::string& text, const std::string& name) {
  return scenario_of(io::parse_yaml(text, name), name);
}

}  // namespace holdfast::simulation
