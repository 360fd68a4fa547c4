#include "holdfast/places/places.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <nanoflann.hpp>

#include "holdfast/core/point_set.hpp"
#include "holdfast/map/map_files.hpp"
#include "holdfast/map/map_info.hpp"
#include "holdfast/places/places_format.hpp"

namespace holdfast::places {
namespace {

Eigen::Vector3f weighed(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), Places::kHeightWeight * p.z()};
}

Result<std::vector<Place>> parse(const std::filesystem::path& path,
                                 const std::vector<std::byte>& bytes) {
  PlacesHeader header;
  if (bytes.size() < sizeof(header)) {
    return Error{fmt::format("{}: {} bytes, at least {} expected", path.string(), bytes.size(),
                             sizeof(header))};
  }
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.magic != kPlacesMagic) {
    return Error{fmt::format("{}: not the places of a holdfast map", path.string())};
  }
  if (header.version != kPlacesVersion || header.record_bytes != sizeof(Place)) {
    return Error{fmt::format(
        "{}: places format {} with records of {} bytes, this program reads {} "
        "with {}: import the map again",
        path.string(), header.version, header.record_bytes, kPlacesVersion, sizeof(Place))};
  }
  const std::size_t expected = sizeof(header) + std::size_t{header.count} * sizeof(Place);
  if (bytes.size() != expected) {
    return Error{fmt::format("{}: {} bytes, {} expected for {} places", path.string(), bytes.size(),
                             expected, header.count)};
  }
  std::vector<Place> places(header.count);
  if (!places.empty()) {
    std::memcpy(static_cast<void*>(places.data()), bytes.data() + sizeof(header),
                places.size() * sizeof(Place));
  }
  return places;
}

}  // namespace

/// A k-d tree over the positions with their heights weighed.
struct Places::Index {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSet>,
                                                   PointSet, 3, std::uint32_t>;
  explicit Index(const std::vector<Place>& places)
      : points(weighed_positions(places)),
        set{points},
        tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}

  static std::vector<Eigen::Vector3f> weighed_positions(const std::vector<Place>& places) {
    std::vector<Eigen::Vector3f> points;
    points.reserve(places.size());
    for (const Place& place : places) points.push_back(weighed(place.position));
    return points;
  }

  std::vector<Eigen::Vector3f> points;
  PointSet set;
  Tree tree;
};

Places::Places(std::vector<Place> places, const Eigen::Vector3d& origin)
    : places_(std::move(places)),
      origin_(origin),
      index_(places_.empty() ? nullptr : std::make_unique<Index>(places_)) {}
Places::Places(Places&& other) noexcept = default;
Places& Places::operator=(Places&& other) noexcept = default;
Places::~Places() = default;

Result<Places> Places::open(const std::filesystem::path& dir) {
  const auto info = map::read_map_info(dir);
  if (!info) return info.error();
  if (!info->places) return Places({}, info->origin);
  const auto path = dir / map::kPlacesFileName;
  const auto bytes = map::read_checked(path, info->places->bytes, info->places->checksum);
  if (!bytes) return bytes.error();
  auto places = parse(path, *bytes);
  if (!places) return places.error();
  return Places(std::move(*places), info->origin);
}

const Place* Places::nearest(const Eigen::Vector3d& p_map, double reach_m) const {
  if (!index_ || !p_map.allFinite()) return nullptr;
  const Eigen::Vector3f p = weighed((p_map - origin_).cast<float>());
  std::uint32_t number = 0;
  float distance_sq = 0;
  nanoflann::KNNResultSet<float, std::uint32_t> found(1);
  found.init(&number, &distance_sq);
  index_->tree.findNeighbors(found, p.data(), nanoflann::SearchParams());
  if (found.size() == 0 || distance_sq > reach_m * reach_m) return nullptr;
  return &places_[number];
}

}  // namespace holdfast::places
