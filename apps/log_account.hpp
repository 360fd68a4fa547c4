#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/io/log_file.hpp"

namespace holdfast::apps {

/// What reading a log survived, for summary.json.
std::vector<std::pair<std::string, std::uint64_t>> counters_of(const io::LogReader& reader);
/// What of it a user should know, as sentences.
std::vector<std::string> warnings_of(const io::LogReader& reader);

}  // namespace holdfast::apps
