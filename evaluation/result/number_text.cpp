#include "evaluation/result/number_text.hpp"

#include <fmt/core.h>

#include <cmath>

namespace holdfast::evaluation {
namespace {

/// Three significant digits for sizes below 1000, without an exponent.
std::string three_digits(double value) {
  const double size = std::abs(value);
  const int decimals = size < 0.9995 ? 3 : size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

std::string length_text(double metres) {
  if (!std::isfinite(metres)) return "-";
  if (std::abs(metres) >= 0.09995) return three_digits(metres) + " m";
  const double mm = 1000 * metres;
  return fmt::format("{:.{}f} mm", mm, std::abs(mm) < 0.9995 ? 2 : 1);
}

std::string angle_text(double degrees) {
  return std::isfinite(degrees) ? three_digits(degrees) + " deg" : "-";
}

std::string share_text(double share) {
  if (!std::isfinite(share)) return "-";
  if (share == 0 || share == 1) return fmt::format("{:.0f} %", 100 * share);
  if (share < 0.0005) return "< 0.1 %";
  if (share > 0.9995) return "> 99.9 %";
  return fmt::format("{:.1f} %", 100 * share);
}

std::string seconds_text(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  return fmt::format("{:.{}f} s", seconds, std::abs(seconds) < 10 ? 2 : 1);
}

std::string milliseconds_text(double milliseconds) {
  return std::isfinite(milliseconds) ? three_digits(milliseconds) + " ms" : "-";
}

std::string count_text(double count) {
  if (!std::isfinite(count)) return "-";
  std::string digits = fmt::format("{:.0f}", std::abs(count));
  for (std::size_t group = 3; group < digits.size(); group += 4)
    digits.insert(digits.size() - group, " ");
  return count < 0 ? fmt::format("-{}", digits) : digits;
}

std::string plain_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

}  // namespace holdfast::evaluation
