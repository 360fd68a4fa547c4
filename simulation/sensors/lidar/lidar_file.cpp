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
constexpr std::array<std::string_view, 7> kNames = {"rs16",   "vlp16",   "helios16", "hdl64",
                                                    "os1_64", "os1_128", "mid360"};

/// A LiDAR as a file holds it, but for its faults.
struct LidarFields {
  std::string pattern = "spinning";
  std::vector<double> elevations_deg;
  int beams = 16;
  double lowest_deg = -15, highest_deg = 15;
  double fire_step_us = 0;
  int columns = 1800;
  double rate_hz = 10;
  double min_range_m = 0.4, max_range_m = 100;
  double range_sigma_m = 0.02;
  double turn_hz = RosettePattern().turn_hz, nod_hz = RosettePattern().nod_hz;
  double divergence_mrad = 3;
  double pulse_length_m = LidarModel().pulse_length_m;
  double reach_at_10_percent_m = LidarModel().reach_at_10_percent_m;
  SE3 T_body_lidar = LidarModel::rs16().T_body_lidar;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    FieldDoc pattern{
        "spinning: all frames have the same rays; rosette: the head turns with `turn_hz` while "
        "`beams` lines nod, each over its share of the field from `lowest_deg` to `highest_deg`, "
        "with `columns` shots of each line a frame and `rate_hz` frames"};
    pattern.choices = "spinning|rosette";
    visit("pattern", self.pattern, pattern);
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
    visit("turn_hz", self.turn_hz,
          FieldDoc{"of a rosette; at most `rate_hz`, and frames repeat unless it is no neat share "
                   "of it",
                   0.1, 100});
    visit("nod_hz", self.nod_hz, FieldDoc{"of a rosette", 0.1, 10000});
    visit("divergence_mrad", self.divergence_mrad,
          FieldDoc{"full angle of a beam; what faults make of it, see below", 0.01, 50});
    visit("pulse_length_m", self.pulse_length_m,
          FieldDoc{"half of the way of light during a pulse: surfaces along a beam that are nearer "
                   "to each other are not told apart",
                   0.01, 10});
    visit("reach_at_10_percent_m", self.reach_at_10_percent_m,
          FieldDoc{"range at which half of the returns of a surface of 10 % that is square to the "
                   "beam are seen in clear air; only with `limited_reach` or in weather",
                   0.1, 10000});
    visit("T_body_lidar", self.T_body_lidar, FieldDoc{"where it is mounted on the IMU"});
  }
};

/// Of the lines of a rosette: the middles of their bands.
std::vector<double> elevations_of(const LidarFields& file) {
  const bool is_rosette = file.pattern == "rosette";
  if (!file.elevations_deg.empty() && !is_rosette) return file.elevations_deg;
  std::vector<double> even;
  for (int i = 0; i < file.beams; ++i) {
    double u = file.beams > 1 ? static_cast<double>(i) / (file.beams - 1) : 0.5;
    if (is_rosette) u = (i + 0.5) / file.beams;
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

/// What is wrong with a rosette, empty when nothing is.
std::string rosette_complaint(const LidarFields& file) {
  if (!file.elevations_deg.empty()) {
    return "elevations_deg: a rosette has a field from lowest_deg to highest_deg instead";
  }
  if (file.highest_deg <= file.lowest_deg) return "highest_deg: expected more than lowest_deg";
  if (file.turn_hz > file.rate_hz) {
    return fmt::format("turn_hz: expected at most rate_hz, {}, found {}", file.rate_hz,
                       file.turn_hz);
  }
  return {};
}

void add_pattern(const LidarFields& file, LidarModel& model) {
  if (file.pattern == "spinning") return;
  const double half_band_deg = (file.highest_deg - file.lowest_deg) / (2 * file.beams);
  model.rosette = RosettePattern{file.turn_hz, file.nod_hz, half_band_deg * kDegree};
}

Result<LidarModel> model_of(const LidarFields& file, const std::string& name) {
  if (file.pattern == "rosette") {
    if (const std::string wrong = rosette_complaint(file); !wrong.empty()) {
      return Error{name + ": " + wrong};
    }
  }
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
  model.divergence_rad = 1e-3 * file.divergence_mrad;
  model.pulse_length_m = file.pulse_length_m;
  model.reach_at_10_percent_m = file.reach_at_10_percent_m;
  add_pattern(file, model);
  return model;
}

Result<LidarModel> read(const Result<YAML::Node>& document, const std::string& name) {
  if (!document) return document.error();
  LidarFields file;
  LidarFaults faults;
  std::vector<io::FieldRef> fields;
  io::collect_fields("", file, fields);
  io::collect_fields("faults", faults, fields);
  if (auto done = io::read_block(*document, name, fields); !done) return done.error();
  auto model = model_of(file, name);
  if (model) model->faults = faults;
  return model;
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
  LidarFaults faults;
  io::collect_fields("lidar", file, fields);
  io::collect_fields("faults", faults, fields);
  return io::config_reference(fields);
}

}  // namespace holdfast::simulation
