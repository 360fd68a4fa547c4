#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace holdfast::io::files {

/// The next word of `text` between blanks (space, tab, carriage return), cut off its front; empty
/// at the end.
std::string_view take_word(std::string_view& text);

/// The next line of `text` without its end, cut off its front. False at the end of the text.
bool take_line(std::string_view& text, std::string_view& line);

std::vector<std::string_view> split_words(std::string_view line);

/// The whole word as a number ("1", "-2.5e-3", "+7", "nan", "inf"); empty if it is not one.
std::optional<double> parse_double(std::string_view word);
std::optional<long long> parse_integer(std::string_view word);

}  // namespace holdfast::io::files
