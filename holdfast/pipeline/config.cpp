#include "holdfast/pipeline/config.hpp"

namespace holdfast::pipeline {

std::vector<io::FieldRef> fields_of(Config& config) {
  std::vector<io::FieldRef> fields;
  io::collect_fields("", config, fields);
  io::collect_fields("lidar", config.lidar, fields);
  io::collect_fields("imu", config.imu, fields);
  io::collect_fields("start", config.start, fields);
  io::collect_fields("preprocess", config.preprocess, fields);
  io::collect_fields("feature_extraction", config.feature_extraction, fields);
  io::collect_fields("query_matching", config.query_matching, fields);
  io::collect_fields("map_filter", config.map_filter, fields);
  io::collect_fields("estimator", config.estimator, fields);
  io::collect_fields("estimator.unmeasured", config.estimator.noise.unmeasured, fields);
  io::collect_fields("graph", config.graph, fields);
  io::collect_fields("odometry", config.odometry, fields);
  io::collect_fields("odometry.local_map", config.local_map, fields);
  io::collect_fields("monitor", config.monitor, fields);
  io::collect_fields("monitor.belief", config.monitor.belief, fields);
  io::collect_fields("monitor.dual_index", config.dual_index, fields);
  io::collect_fields("relocalization", config.relocalization, fields);
  io::collect_fields("relocalization.search", config.search, fields);
  return fields;
}

Result<Config> load_config(const std::filesystem::path& file,
                           const std::vector<std::string>& assignments) {
  Config config;
  auto fields = fields_of(config);
  if (!file.empty()) {
    if (auto read = io::read_config_file(file, fields); !read) return read.error();
  }
  for (const std::string& assignment : assignments) {
    if (auto set = io::set_field(assignment, fields); !set) return set.error();
  }
  const std::string place = file.empty() ? "no --config given" : file.string();
  if (auto complete = io::check_required(place, fields); !complete) return complete.error();
  return config;
}

}  // namespace holdfast::pipeline
