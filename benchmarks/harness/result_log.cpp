#include "benchmarks/harness/result_log.hpp"

#include <fmt/format.h>

#include <fstream>

namespace holdfast::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTerms = "terms";
constexpr const char* kKey = "key";
constexpr const char* kResult = "result";

Status append(const std::filesystem::path& file, const Json& line) {
  std::ofstream out(file, std::ios::app);
  out << line.dump() << "\n" << std::flush;
  if (!out) return Error{fmt::format("{}: cannot be written", file.string())};
  return Done{};
}

}  // namespace

Result<ResultLog> ResultLog::open(const std::filesystem::path& file, const Json& terms) {
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  ResultLog log;
  log.file_ = file;
  if (!std::filesystem::exists(file)) {
    if (auto begun = append(file, {{kTerms, terms}}); !begun) return begun.error();
    return log;
  }
  if (auto read = log.read(terms); !read) return read.error();
  return log;
}

Status ResultLog::read(const Json& terms) {
  std::ifstream in(file_);
  std::uintmax_t whole = 0;  // bytes of whole lines
  bool first = true;
  for (std::string text; std::getline(in, text) && !in.eof(); whole += text.size() + 1) {
    const Json line = Json::parse(text, nullptr, false);
    const bool ours = line.is_object() && (first ? line.contains(kTerms)
                                                 : line.contains(kKey) && line.contains(kResult));
    if (!ours) return Error{fmt::format("{}: not results of this bench", file_.string())};
    if (first && line[kTerms] != terms) {
      return Error{
          fmt::format("{} holds results for {}; these would be for {}: remove it, or choose "
                      "another folder",
                      file_.string(), line[kTerms].dump(), terms.dump())};
    }
    if (!first) known_[line[kKey].get<std::string>()] = line[kResult];
    first = false;
  }
  std::error_code failure;
  std::filesystem::resize_file(file_, whole, failure);
  if (failure) return Error{fmt::format("{}: {}", file_.string(), failure.message())};
  return first ? append(file_, {{kTerms, terms}}) : Status(Done{});
}

std::optional<Json> ResultLog::find(const std::string& key) const {
  const auto at = known_.find(key);
  if (at == known_.end()) return std::nullopt;
  return at->second;
}

Status ResultLog::add(const std::string& key, const Json& result) {
  known_[key] = result;
  if (file_.empty()) return Done{};
  return append(file_, {{kKey, key}, {kResult, result}});
}

}  // namespace holdfast::benchmarks
