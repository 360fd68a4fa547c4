#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/result.hpp"
#include "holdfast/io/bag/bag_file.hpp"

namespace holdfast::io::logs {

/// Which topic is looked for.
struct TopicRequest {
  std::string_view type;    ///< "sensor_msgs/Imu"
  std::string_view md5;     ///< of the version that can be read
  std::string_view option;  ///< that names the topic on the command line, "--imu"
  std::string topic;        ///< as the user gave it; empty: the only topic of this type
  bool required = true;     ///< false: no topic of this type is no error
};

/// For each connection of the bag whether it belongs to the requested topic; all false if there is
/// none and none is required. Errors list the bag's topics and name the option that picks one.
Result<std::vector<bool>> select_topic(const bag::BagFile& bag, const TopicRequest& request);

}  // namespace holdfast::io::logs
