#include "holdfast/io/tum_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "holdfast/io/atomic_output.hpp"
#include "holdfast/io/files/errors.hpp"
#include "holdfast/io/files/input_file.hpp"
#include "holdfast/io/files/numbers.hpp"

namespace holdfast::io {
namespace {

constexpr std::size_t kColumns = 8;

Result<StampedPose> parse_line(std::string_view line) {
  const auto words = files::split_words(line);
  if (words.size() != kColumns) {
    return Error{fmt::format("{} values, expected the 8 of 't x y z qx qy qz qw'", words.size())};
  }
  StampedPose pose;
  if (!parse_seconds(std::string(words[0]), pose.t)) {
    return Error{fmt::format("time '{}' is not a number of seconds", words[0])};
  }
  std::array<double, kColumns - 1> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = files::parse_double(words[i + 1]);
    if (!value || !std::isfinite(*value)) {
      return Error{fmt::format("'{}' is not a finite number", words[i + 1])};
    }
    values[i] = *value;
  }
  pose.T_map_body.translation = {values[0], values[1], values[2]};
  const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
  const double norm = q.coeffs().stableNorm();
  if (norm < 1e-6) return Error{"the quaternion is zero, expected a unit quaternion"};
  pose.T_map_body.rotation.coeffs() = q.coeffs() / norm;
  return pose;
}

}  // namespace

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path) {
  const auto text = files::read_text(path);
  if (!text) return text.error();
  std::vector<StampedPose> poses;
  std::string_view rest = *text;
  std::string_view line;
  for (std::size_t number = 1; files::take_line(rest, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const auto pose = parse_line(line);
    if (!pose) return files::error_at(path, "line {}: {}", number, pose.error().message);
    if (!poses.empty() && pose->t < poses.back().t) {
      return files::error_at(path, "line {}: time {} runs back, the line before has {}", number,
                             format_seconds(pose->t), format_seconds(poses.back().t));
    }
    poses.push_back(*pose);
  }
  return poses;
}

std::string format_tum_line(const StampedPose& pose) {
  const auto& p = pose.T_map_body.translation;
  const auto& q = pose.T_map_body.rotation;
  return fmt::format("{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}", format_seconds(pose.t),
                     p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

Status write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses) {
  std::string text;
  for (const auto& pose : poses) {
    text += format_tum_line(pose);
    text += '\n';
  }
  return write_file_atomically(path, text);
}

}  // namespace holdfast::io
