#pragma once

#include <string>

/// Figures as people read them. "-" stands for what is not known.
namespace holdfast::evaluation {

/// "1.9 mm" below 0.1 m, else "0.123 m", "12.3 m".
std::string length_text(double metres);
/// "0.021 deg", "1.23 deg", "12.3 deg".
std::string angle_text(double degrees);
/// "99.8 %"; never rounded to 100 % or 0 % unless it is that.
std::string share_text(double share);
/// "0.83 s", "61.2 s".
std::string seconds_text(double seconds);
/// "0.74 ms".
std::string milliseconds_text(double milliseconds);
/// "12 345".
std::string count_text(double count);
/// Three significant digits.
std::string plain_text(double value);

}  // namespace holdfast::evaluation
