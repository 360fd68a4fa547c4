#include "holdfast/core/time.hpp"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace holdfast {
namespace {

/// Digits of plain decimal notation from `text[at]`; -1 where there is none or the value overflows.
std::int64_t read_digits(const std::string& text, std::size_t& at, std::size_t most) {
  std::int64_t value = 0;
  const std::size_t begin = at;
  for (; at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0; ++at) {
    if (at - begin >= most) continue;
    value = value * 10 + (text[at] - '0');
  }
  return at == begin ? -1 : value;
}

bool parse_scientific(const std::string& text, TimeNs& t) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size() || text.empty()) return false;
  if (!std::isfinite(value) || std::abs(value) > 9e9) return false;
  t = from_seconds(value);
  return true;
}

}  // namespace

std::string format_seconds(TimeNs t) {
  const bool negative = t < 0;
  const std::uint64_t magnitude =
      negative ? 0 - static_cast<std::uint64_t>(t) : static_cast<std::uint64_t>(t);
  char text[32];
  std::snprintf(text, sizeof(text), "%s%llu.%09llu", negative ? "-" : "",
                static_cast<unsigned long long>(magnitude / 1'000'000'000ULL),
                static_cast<unsigned long long>(magnitude % 1'000'000'000ULL));
  return text;
}

bool parse_seconds(const std::string& text, TimeNs& t) {
  const bool negative = !text.empty() && text[0] == '-';
  std::size_t at = negative ? 1 : 0;
  const std::int64_t whole = read_digits(text, at, 10);
  if (whole < 0 || at - (negative ? 1 : 0) > 10) return parse_scientific(text, t);
  std::int64_t fraction = 0;
  if (at < text.size() && text[at] == '.') {
    const std::size_t begin = ++at;
    fraction = std::max<std::int64_t>(read_digits(text, at, 9), 0);
    for (std::size_t digits = at - begin; digits < 9; ++digits) fraction *= 10;
  }
  if (at != text.size()) return parse_scientific(text, t);
  t = (negative ? -1 : 1) * (whole * kSecond + fraction);
  return true;
}

}  // namespace holdfast
