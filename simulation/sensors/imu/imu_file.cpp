#include "simulation/sensors/imu/imu_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "holdfast/io/yaml_block.hpp"

namespace holdfast::simulation {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"article", "n200", "bmi088"};

/// What single keys cannot say, empty when nothing is wrong.
std::string contradiction(const ImuModel& imu) {
  const double interval_ns = 1e9 / imu.rate_hz;
  if (std::abs(interval_ns - std::round(interval_ns)) > 1e-6) {
    return fmt::format("rate_hz: expected a whole number of ns between samples, found {} Hz",
                       imu.rate_hz);
  }
  const ImuFaults& faults = imu.faults;
  const auto coarse = [](double resolution, double full_scale) {
    return full_scale > 0 && resolution > full_scale;
  };
  if (coarse(faults.gyro_resolution_rad_s, faults.gyro_full_scale_rad_s)) {
    return "gyro_resolution_rad_s: expected less than gyro_full_scale_rad_s";
  }
  if (coarse(faults.accel_resolution_m_s2, faults.accel_full_scale_m_s2)) {
    return "accel_resolution_m_s2: expected less than accel_full_scale_m_s2";
  }
  if (faults.accel_full_scale_m_s2 > 0 && faults.accel_full_scale_m_s2 < imu.gravity_map.norm()) {
    return fmt::format("accel_full_scale_m_s2: expected more than gravity, found {}",
                       faults.accel_full_scale_m_s2);
  }
  return {};
}

Result<ImuModel> read(const Result<YAML::Node>& document, const std::string& name) {
  if (!document) return document.error();
  ImuModel imu;
  std::vector<io::FieldRef> fields;
  io::collect_fields("", imu, fields);
  if (auto done = io::read_block(*document, name, fields); !done) return done.error();
  const std::string wrong = contradiction(imu);
  if (!wrong.empty()) return Error{fmt::format("{}: {}", name, wrong)};
  return imu;
}

}  // namespace

std::vector<std::string_view> imu_names() { return {kNames.begin(), kNames.end()}; }

Result<ImuModel> make_imu(const std::string& name) {
  if (name == "article") return ImuModel();
  if (name.ends_with(".yaml")) return read(io::load_yaml(name), name);
  const std::string file = name + ".yaml";
  const std::string text(imu_text(file));
  if (text.empty()) {
    return Error{fmt::format("unknown imu '{}'; known are: {}, and files that end in .yaml", name,
                             fmt::join(kNames, ", "))};
  }
  return read(io::parse_yaml(text, file), file);
}

std::string imu_reference() {
  ImuModel imu;
  std::vector<io::FieldRef> fields;
  io::collect_fields("imu", imu, fields);
  return fmt::format(
      "# IMU files\n\n"
      "`--imu FILE.yaml` takes an IMU from a file; `--imu NAME` one of {}. What a file does not\n"
      "say is as in `article`, the default, whose faults are all off. `--faults imu` turns on\n"
      "those that are usual for an industrial MEMS where the IMU has none of its own.\n\n{}",
      fmt::join(kNames, ", "), io::config_reference(fields));
}

}  // namespace holdfast::simulation
