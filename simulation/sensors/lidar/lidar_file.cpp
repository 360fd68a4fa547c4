#include "simulation/sensors/lidar/lidar_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "holdfast/io/yaml_block.hpp"

namespace holdfast::simulation {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kMostBeams = 1024;
constexpr std::array<std::string_view, 5> kNames = {"rs16", "vlp16", "hdl64", "os1_64", "os1_128"};

/// A spinning LiDAR as a file holds it.
struct LidarFields {
  std::vector<double> elevations_deg;
  int beams = 16;
  double lowest_deg = -15, highest_deg = 15;
  double fire_step_us = 0;
  int columns = 1800;
  double rate_hz = 10;
  double min_range_m = 0.4, max_range_m = 100;
  double range_sigma_m = 0.02;
  SE3 T_body_lidar = LidarModel::rs16().T_body_lidar;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "elevations_deg", self.elevations_deg,
        FieldDoc{"of the beams above the horizon, in the order in which they fire; an empty list: "
                 "evenly from `lowest_deg` to `highest_deg`",
                 -90, 90});
    visit("beams", self.beams, FieldDoc{"their number, if they are even", 1, 1024});
    visit("lowest_deg", self.lowest_deg, FieldDoc{"of even beams", -90, 90});
    visit("highest_deg", self.highest_deg, FieldDoc{"of even beams", -90, 90});
    visit("fire_step_us", self.fire_step_us,
          FieldDoc{"from one beam of a column to the next; 0: all at once", 0, 1000});
    visit("columns", self.columns, FieldDoc{"a revolution", 1, 100000});
    visit("rate_hz", self.rate_hz, FieldDoc{"revolutions", 0.1, 100});
    visit("min_range_m", self.min_range_m, FieldDoc{"nearer surfaces return nothing", 0, 100});
    visit("max_range_m", self.max_range_m, FieldDoc{"farther surfaces return nothing", 0.1, 10000});
    visit("range_sigma_m", self.range_sigma_m, FieldDoc{"noise of a range", 0, 1});
    visit("T_body_lidar", self.T_body_lidar, FieldDoc{"where it is mounted on the IMU"});
  }
};

std::vector<double> elevations_of(const LidarFields& file) {
  if (!file.elevations_deg.empty()) return file.elevations_deg;
  std::vector<double> even;
  for (int i = 0; i < file.beams; ++i) {
    const double u = file.beams > 1 ? static_cast<double>(i) / (file.beams - 1) : 0.5;
    even.push_back(std::lerp(file.lowest_deg, file.highest_deg, u));
  }
  return even;
}

/// Place of each in ascending order.
std::vector<std::uint16_t> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::uint16_t> ranks(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<std::uint16_t>(i);
  return ranks;
}

Result<LidarModel> model_of(const LidarFields& file, const std::string& name) {
  const std::vector<double> elevations = elevations_of(file);
  LidarModel model;
  model.columns = file.columns;
  model.period = from_seconds(1.0 / file.rate_hz);
  const double column_us = 1e-3 * static_cast<double>(model.period) / file.columns;
  const double fired_us = file.fire_step_us * static_cast<double>(elevations.size() - 1);
  if (elevations.size() > kMostBeams) {
    return Error{fmt::format("{}: elevations_deg: expected at most {} beams, found {}", name,
                             kMostBeams, elevations.size())};
  }
  if (fired_us >= column_us) {
    return Error{
        fmt::format("{}: fire_step_us: {} beams take {:.1f} us, expected less than the {:.1f} "
                    "us of a column",
                    name, elevations.size(), fired_us, column_us)};
  }
  if (file.max_range_m <= file.min_range_m) {
    return Error{fmt::format("{}: max_range_m: expected more than min_range_m", name)};
  }
  const auto rings = ranks_of(elevations);
  for (std::size_t i = 0; i < elevations.size(); ++i) {
    const double offset_us = file.fire_step_us * static_cast<double>(i);
    model.beams.push_back(
        {elevations[i] * kDegree, static_cast<TimeNs>(std::llround(1e3 * offset_us)), rings[i]});
  }
  model.min_range_m = file.min_range_m;
  model.max_range_m = file.max_range_m;
  model.range_sigma_m = file.range_sigma_m;
  model.T_body_lidar = file.T_body_lidar;
  return model;
}

Result<LidarModel> read(const Result<YAML::Node>& document, const std::string& name) {
  if (!document) return document.error();
  LidarFields file;
  std::vector<io::FieldRef> fields;
  io::collect_fields("", file, fields);
  if (auto done = io::read_block(*document, name, fields); !done) return done.error();
  return model_of(file, name);
}

}  // namespace

std::vector<std::string_view> lidar_names() { return {kNames.begin(), kNames.end()}; }

Result<LidarModel> make_lidar(const std::string& name) {
  if (name == "rs16") return LidarModel::rs16();
  if (name == "os1_128") return LidarModel::os1_128();
  if (name.ends_with(".yaml")) return read(io::load_yaml(name), name);
  const std::string file = name + ".yaml";
  const std::string text(lidar_text(file));
  if (text.empty()) {
    return Error{fmt::format("unknown lidar '{}'; known are: {}, and files that end in .yaml", name,
                             fmt::join(kNames, ", "))};
  }
  return read(io::parse_yaml(text, file), file);
}

std::string lidar_reference() {
  LidarFields file;
  std::vector<io::FieldRef> fields;
  io::collect_fields("lidar", file, fields);
  return io::config_reference(fields);
}

}  // namespace holdfast::simulation
