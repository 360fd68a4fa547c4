#include "evaluation/files/map_view.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/files/text_file.hpp"

namespace holdfast::evaluation {
namespace {

using Json = nlohmann::json;

bool read_point(const Json& json, Eigen::Vector3f& point) {
  if (!json.is_array() || json.size() < 3) return false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Json& coordinate = json[static_cast<std::size_t>(i)];
    if (!coordinate.is_number()) return false;
    point[i] = coordinate.get<float>();
  }
  return point.allFinite();
}

Result<MapView> map_view_of(const std::string& file, const Json& json) {
  if (!json.is_object() || !json.contains("points") || !json["points"].is_array())
    return Error{fmt::format("{}: expected an object with a list \"points\"", file)};
  const Json& points = json["points"];
  const std::size_t stride = (points.size() + kMaxMapViewPoints - 1) / kMaxMapViewPoints;
  MapView view;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    Eigen::Vector3f point;
    if (!read_point(points[i], point))
      return Error{fmt::format("{}: points[{}]: expected three finite numbers, found {}", file, i,
                               points[i].dump().substr(0, 60))};
    view.points.push_back(point);
  }
  return view;
}

}  // namespace

Result<MapView> read_map_view(const std::filesystem::path& path) {
  const Result<std::string> text = read_text(path);
  if (!text) return text.error();
  try {
    return map_view_of(path.string(), Json::parse(*text));
  } catch (const Json::exception& error) {
    return Error{fmt::format("{}: not valid JSON: {}", path.string(), error.what())};
  }
}

}  // namespace holdfast::evaluation
