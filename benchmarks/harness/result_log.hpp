#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "holdfast/core/result.hpp"

namespace holdfast::benchmarks {

/// Results of a long bench, one line of JSON each, written as they come, so that a run that was
/// stopped goes on where it was. Not thread-safe.
class ResultLog {
 public:
  /// Kept in memory only.
  ResultLog() = default;

  /// `terms` is what the results hold for (durations, settings): it is the first line of a new
  /// file. Errors: a file that cannot be written, that is none of ours, or that holds for other
  /// terms. Half a line at the end, as a stopped run leaves it, is dropped.
  static Result<ResultLog> open(const std::filesystem::path& file,
                                const nlohmann::ordered_json& terms);

  /// What a run before has found; none: nothing yet.
  std::optional<nlohmann::ordered_json> find(const std::string& key) const;

  Status add(const std::string& key, const nlohmann::ordered_json& result);

 private:
  Status read(const nlohmann::ordered_json& terms);

  std::filesystem::path file_;
  std::map<std::string, nlohmann::ordered_json> known_;
};

}  // namespace holdfast::benchmarks
