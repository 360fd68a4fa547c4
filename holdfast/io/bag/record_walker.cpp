#include "holdfast/io/bag/record_walker.hpp"

#include <algorithm>

namespace holdfast::io::bag {
namespace {

constexpr std::size_t kLookAhead = 8192;
// Headers hold a few numbers and a topic.
constexpr std::uint32_t kLongestHeader = 1U << 20;

}  // namespace

std::optional<std::string_view> RecordWalker::view(std::uint64_t position, std::size_t size) {
  if (position > file_.size() || size > file_.size() - position) return std::nullopt;
  if (position < window_begin_ || position + size > window_begin_ + window_.size()) {
    const std::uint64_t left = file_.size() - position;
    window_.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(left, std::max(size, kLookAhead))));
    window_.resize(file_.read(position, window_.data(), window_.size()));
    window_begin_ = position;
    if (window_.size() < size) return std::nullopt;
  }
  return std::string_view(window_).substr(static_cast<std::size_t>(position - window_begin_), size);
}

std::optional<RecordPlace> RecordWalker::record_at(std::uint64_t position) {
  const auto header_size = view(position, sizeof(std::uint32_t));
  if (!header_size) return std::nullopt;
  const auto size = files::load<std::uint32_t>(header_size->data());
  if (size > kLongestHeader) return std::nullopt;
  const auto rest = view(position + sizeof(size), std::size_t{size} + sizeof(std::uint32_t));
  if (!rest) return std::nullopt;
  RecordPlace record;
  record.header = rest->substr(0, size);
  record.data_size = files::load<std::uint32_t>(rest->data() + size);
  record.data = position + 2 * sizeof(std::uint32_t) + size;
  return record;
}

std::optional<std::string_view> RecordWalker::data_of(const RecordPlace& record) {
  return view(record.data, record.data_size);
}

}  // namespace holdfast::io::bag
