#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/core/se3.hpp"

/// One field list per configuration struct. A struct lists its members once:
///
///   struct DeskewConfig {
///     double max_gap_s = 0.05;
///     template <class Self, class Visitor>
///     static void fields(Self& self, Visitor& visit) {
///       visit("max_gap_s", self.max_gap_s, FieldDoc{"longest IMU gap bridged", 0.0, 1.0});
///     }
///   };
///
/// and reading, writing, range checks, `--set module.key=value`, the reference page and the test of
/// the shipped default all walk that list (visitors in holdfast/io/config_io.hpp).
/// Field types: bool, int, double, std::string, std::vector<double>, SE3 (as x y z qx qy qz qw).
namespace holdfast {

/// What a field means and which values it may take. Units stand in the key (_m, _s, _hz, _deg).
struct FieldDoc {
  std::string_view text;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  /// For strings: the allowed words, separated by '|'; empty allows any.
  std::string_view choices = {};
};

}  // namespace holdfast
