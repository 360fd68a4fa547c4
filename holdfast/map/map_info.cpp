#include "holdfast/map/map_info.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "holdfast/map/checksum.hpp"

namespace holdfast::map {
namespace {

Eigen::Vector3d vector_of(const YAML::Node& node) {
  return {node[0].as<double>(), node[1].as<double>(), node[2].as<double>()};
}

std::string text_of(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// A tile is one line of text, "ix iy bytes points surface_checksum point_checksum": a large map
/// has thousands, and a YAML mapping for each would take longer to parse than the tiles to load.
TileInfo tile_of(const std::string& line) {
  TileInfo tile;
  unsigned long long bytes = 0, points = 0, surface = 0, point = 0;
  if (std::sscanf(line.c_str(), "%d %d %llu %llu %llx %llx", &tile.ix, &tile.iy, &bytes, &points,
                  &surface, &point) != 6) {
    throw YAML::Exception(YAML::Mark::null_mark(), "not a line of a tile: " + line);
  }
  tile.bytes = bytes;
  tile.points = points;
  tile.surface_checksum = surface;
  tile.point_checksum = point;
  return tile;
}

/// "bytes checksum"
FileInfo file_of(const std::string& line) {
  unsigned long long bytes = 0, sum = 0;
  if (std::sscanf(line.c_str(), "%llu %llx", &bytes, &sum) != 2) {
    throw YAML::Exception(YAML::Mark::null_mark(), "not bytes and checksum of places: " + line);
  }
  return {bytes, sum};
}

void read_levels(const YAML::Node& node, MapInfo& info) {
  for (int i = 0; i < kLevels; ++i) {
    info.levels[i] = {node[i]["cell_m"].as<double>(), node[i]["planes"].as<std::uint64_t>(),
                      node[i]["lines"].as<std::uint64_t>()};
  }
}

MapInfo parse(const YAML::Node& node) {
  MapInfo info;
  info.identity = node["identity"].as<std::string>();
  info.source = node["source"].as<std::string>();
  info.origin = vector_of(node["origin_m"]);
  info.bounds_min = vector_of(node["bounds_m"]["min"]);
  info.bounds_max = vector_of(node["bounds_m"]["max"]);
  info.gravity_map = vector_of(node["gravity_map_m_s2"]);
  info.points = node["points"].as<std::uint64_t>();
  info.spacing_m = node["spacing_m"].as<double>();
  info.noise_m = node["noise_m"].as<double>();
  read_levels(node["levels"], info);
  if (node["places"]) info.places = file_of(node["places"].as<std::string>());
  for (const auto& tile : node["tiles"]) info.tiles.push_back(tile_of(tile.as<std::string>()));
  return info;
}

}  // namespace

std::string TileInfo::stem() const { return fmt::format("tiles/{:+04d}_{:+04d}", ix, iy); }

Result<MapInfo> read_map_info(const std::filesystem::path& dir) {
  const auto path = dir / kMapFileName;
  if (!std::filesystem::exists(path)) {
    return Error{fmt::format("{}: not a map: no {} in it (make one with `holdfast map import`)",
                             dir.string(), kMapFileName)};
  }
  try {
    const YAML::Node node = YAML::LoadFile(path.string());
    const int version = node["format_version"].as<int>();
    if (version != kMapFormatVersion) {
      return Error{fmt::format(
          "{}: format_version {}, this program reads {}: make the map again with this version, or "
          "update the program",
          path.string(), version, kMapFormatVersion)};
    }
    return parse(node);
  } catch (const YAML::Exception& e) {
    return Error{fmt::format("{}: cannot be read: {}", path.string(), e.what())};
  }
}

std::string format_map_info(const MapInfo& info) {
  std::string text = fmt::format(
      "format_version: {}\nidentity: {}\nsource: {}\norigin_m: {}\nbounds_m:\n  min: {}\n  max: "
      "{}\n"
      "gravity_map_m_s2: {}\ntile_size_m: {}\npoints: {}\nspacing_m: {:.4f}\nnoise_m: {:.5f}\n"
      "levels:\n",
      kMapFormatVersion, info.identity, YAML::Dump(YAML::Node(info.source)), text_of(info.origin),
      text_of(info.bounds_min), text_of(info.bounds_max), text_of(info.gravity_map), kTileSizeM,
      info.points, info.spacing_m, info.noise_m);
  for (const auto& level : info.levels) {
    text += fmt::format("  - {{cell_m: {}, planes: {}, lines: {}}}\n", level.cell_m, level.planes,
                        level.lines);
  }
  if (info.places) {
    text += fmt::format("places: {} {:016x}  # bytes checksum\n", info.places->bytes,
                        info.places->checksum);
  }
  text += "tiles:  # ix iy bytes points surface_checksum point_checksum\n";
  for (const auto& t : info.tiles) {
    text += fmt::format("  - {} {} {} {} {:016x} {:016x}\n", t.ix, t.iy, t.bytes, t.points,
                        t.surface_checksum, t.point_checksum);
  }
  return text;
}

std::string identity_of(const std::vector<TileInfo>& tiles) {
  std::vector<std::uint64_t> sums;
  for (const auto& tile : tiles) {
    sums.push_back(tile.surface_checksum);
    sums.push_back(tile.point_checksum);
  }
  return fmt::format("{:016x}", checksum(sums.data(), sums.size() * sizeof(std::uint64_t)));
}

}  // namespace holdfast::map
