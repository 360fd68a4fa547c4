#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/core/sensor_data.hpp"
#include "holdfast/io/files/bytes.hpp"

namespace holdfast::io::ros {

/// Reads a std_msgs/Header and returns its stamp; empty if the bytes end in it or the stamp is
/// none.
std::optional<TimeNs> read_header_stamp(files::ByteReader& reader);
void append_header(std::string& out, std::uint32_t sequence, TimeNs stamp, std::string_view frame);

/// A serialised sensor_msgs/Imu; empty if its size is wrong. Values are as the sensor gave them and
/// may be non-finite.
std::optional<ImuSample> parse_imu(std::string_view message);

/// Without orientation (covariance -1, as the message's definition demands) and with unknown (zero)
/// covariances.
std::string serialise_imu(const ImuSample& sample, std::uint32_t sequence, std::string_view frame);

}  // namespace holdfast::io::ros
