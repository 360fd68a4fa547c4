#include "simulation/world/survey.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "holdfast/core/random.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kStationStep = 0.5;    // metres along the route
constexpr double kStationAside = 0.15;  // to alternating sides: robots do not drive on rails
constexpr std::int64_t kBlock = 32;     // squares along a side of what shares one list of stations
constexpr std::size_t kNearStations = 16;
constexpr std::size_t kFarStride = 4;  // of the stations further away only one in so many is tried
constexpr std::size_t kChunkTriangles = 16;
constexpr float kDiscBlock = 4;  // metres along a side of what shares one list of stations
constexpr std::size_t kNearDiscStations = 8;
constexpr std::size_t kFarDiscStations = 24;  // at most, spread over those further away
constexpr std::size_t kChunkBlocks = 16;

/// Where the LiDAR stands along the route.
std::vector<Vector3d> stations_along(const Route& route, double height) {
  std::vector<Vector3d> stations;
  double side = kStationAside;
  for (double s = 0; s < route.length(); s += kStationStep, side = -side) {
    const Route::Place place = route.at(s);
    stations.push_back(place.position + Vector3d(-side * std::sin(place.heading),
                                                 side * std::cos(place.heading), height));
  }
  return stations;
}

/// A triangle in the squares of its plane. Triangles of one plane share the squares.
struct Facet {
  Vector3d normal;
  Vector3d u_axis;
  Vector3d v_axis;
  double offset = 0;  ///< of the plane along the normal
  std::array<Vector2d, 3> corners;
  Vector2d low;
  Vector2d high;

  Facet(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    normal = (b - a).cross(c - a).normalized();
    const Vector3d aside = std::abs(normal.z()) > 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
    u_axis = aside.cross(normal).normalized();
    v_axis = normal.cross(u_axis);
    offset = normal.dot(a);
    corners = {in_plane(a), in_plane(b), in_plane(c)};
    low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  }
  Vector2d in_plane(const Vector3d& p) const { return {u_axis.dot(p), v_axis.dot(p)}; }
  Vector3d in_space(const Vector2d& p) const {
    return p.x() * u_axis + p.y() * v_axis + offset * normal;
  }
  bool contains(const Vector2d& p) const {
    for (int i = 0; i < 3; ++i) {
      const Vector2d edge = corners[(i + 1) % 3] - corners[i];
      const Vector2d to = p - corners[i];
      if (edge.x() * to.y() - edge.y() * to.x() < 0) return false;
    }
    return true;
  }
};

/// Surveys a run of triangles.
class Surveyor {
 public:
  Surveyor(const RayCaster& caster, const std::vector<Vector3d>& stations, const SurveyModel& model,
           std::uint64_t seed, const std::string& chunk)
      : caster_(caster),
        stations_(stations),
        model_(model),
        seed_(seed),
        noise_(seed, "survey.noise." + chunk),
        keep_(seed, "survey.keep." + chunk) {}

  void add(const Facet& facet, double share) {
    const auto square = [&](double x) {
      return static_cast<std::int64_t>(std::floor(x / model_.spacing_m));
    };
    const std::int64_t i_end = square(facet.high.x()) + 1;
    const std::int64_t j_end = square(facet.high.y()) + 1;
    for (std::int64_t i = square(facet.low.x()); i < i_end; i += kBlock) {
      for (std::int64_t j = square(facet.low.y()); j < j_end; j += kBlock) {
        add_block(facet, share, i, std::min(i + kBlock, i_end), j, std::min(j + kBlock, j_end));
      }
    }
  }

  std::vector<Vector3f> points;

 private:
  void add_block(const Facet& facet, double share, std::int64_t i0, std::int64_t i1,
                 std::int64_t j0, std::int64_t j1) {
    std::vector<Vector3d> candidates;
    for (std::int64_t i = i0; i < i1; ++i) {
      for (std::int64_t j = j0; j < j1; ++j) {
        const Vector2d p = point_in_square(i, j);
        if (facet.contains(p)) candidates.push_back(facet.in_space(p));
      }
    }
    if (candidates.empty()) return;
    choose_stations(facet, candidates[candidates.size() / 2]);
    for (const Vector3d& p : candidates) {
      if (share < 1 && keep_.uniform() >= share) continue;
      if (!is_seen(facet, p)) continue;
      const double x = noise_.normal();
      const double y = noise_.normal();
      points.push_back((p + model_.sigma_m * Vector3d(x, y, noise_.normal())).cast<float>());
    }
  }

  /// Depends on the square and the seed only, so that triangles which share a square agree.
  Vector2d point_in_square(std::int64_t i, std::int64_t j) const {
    const auto key = static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ULL +
                     static_cast<std::uint64_t>(j) * 0xc2b2ae3d27d4eb4fULL;
    RandomStream jitter(seed_ + key, "survey.square");
    const double x = static_cast<double>(i) + jitter.uniform(0.25, 0.75);
    const double y = static_cast<double>(j) + jitter.uniform(0.25, 0.75);
    return model_.spacing_m * Vector2d(x, y);
  }

  /// The stations in front of the facet, nearest first, thinned out further away.
  void choose_stations(const Facet& facet, const Vector3d& near) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const double distance = (stations_[k] - near).norm();
      const bool in_front = facet.normal.dot(stations_[k]) > facet.offset;
      if (in_front && distance <= model_.range_m) order.emplace_back(distance, k);
    }
    std::sort(order.begin(), order.end());
    chosen_.clear();
    for (std::size_t k = 0; k < order.size(); k += k < kNearStations ? 1 : kFarStride) {
      chosen_.push_back(order[k].second);
    }
  }

  bool is_seen(const Facet& facet, const Vector3d& p) const {
    return std::any_of(chosen_.begin(), chosen_.end(), [&](std::size_t k) {
      const Vector3d way = stations_[k] - p;
      return facet.normal.dot(way) >= model_.least_cosine * way.norm() &&
             caster_.is_visible(stations_[k].cast<float>(), p.cast<float>());
    });
  }

  const RayCaster& caster_;
  const std::vector<Vector3d>& stations_;
  const SurveyModel& model_;
  std::uint64_t seed_;
  RandomStream noise_;
  RandomStream keep_;
  std::vector<std::size_t> chosen_;
};

/// Discs that stand near each other, in an order of their own.
using DiscBlock = std::vector<std::uint32_t>;

std::vector<DiscBlock> blocks_of(const std::vector<Disc>& discs) {
  std::vector<std::pair<std::array<std::int32_t, 3>, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < discs.size(); ++i) {
    const Eigen::Array3f cube = (discs[i].center.array() / kDiscBlock).floor();
    order.push_back({{static_cast<std::int32_t>(cube[0]), static_cast<std::int32_t>(cube[1]),
                      static_cast<std::int32_t>(cube[2])},
                     i});
  }
  std::sort(order.begin(), order.end());
  std::vector<DiscBlock> blocks;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || order[k].first != order[k - 1].first) blocks.emplace_back();
    blocks.back().push_back(order[k].second);
  }
  return blocks;
}

/// Surveys blocks of discs.
class DiscSurveyor {
 public:
  DiscSurveyor(const World& world, const RayCaster& caster, const std::vector<Vector3d>& stations,
               const SurveyModel& model)
      : world_(world), caster_(caster), stations_(stations), model_(model) {}

  void add(const DiscBlock& block, RandomStream& noise, RandomStream& keep,
           std::vector<Vector3f>& points) const {
    const std::vector<Vector3f> chosen = stations_near(world_.discs[block.front()].center);
    if (chosen.empty()) return;
    for (const std::uint32_t i : block) {
      const Disc& disc = world_.discs[i];
      const double share = world_.materials[disc.material].survey_return;
      if (share < 1 && keep.uniform() >= share) continue;
      if (!is_seen(disc, chosen)) continue;
      const double x = noise.normal();
      const double y = noise.normal();
      const Vector3d error = model_.sigma_m * Vector3d(x, y, noise.normal());
      points.push_back((disc.center.cast<double>() + error).cast<float>());
    }
  }

 private:
  /// The nearest first, then some of those further away.
  std::vector<Vector3f> stations_near(const Vector3f& place) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const double distance = (stations_[k] - place.cast<double>()).norm();
      if (distance <= model_.range_m) order.emplace_back(distance, k);
    }
    std::sort(order.begin(), order.end());
    const std::size_t far = order.size() - std::min(order.size(), kNearDiscStations);
    const std::size_t stride = std::max<std::size_t>(1, chunk_count(far, kFarDiscStations));
    std::vector<Vector3f> chosen;
    for (std::size_t k = 0; k < order.size(); k += k < kNearDiscStations ? 1 : stride) {
      chosen.push_back(stations_[order[k].second].cast<float>());
    }
    return chosen;
  }

  /// What neighbours that overlap the disc hide of its centre does not count.
  bool is_seen(const Disc& disc, const std::vector<Vector3f>& chosen) const {
    const float slack = 2 * disc.radius + 0.002F;
    return std::any_of(chosen.begin(), chosen.end(), [&](const Vector3f& station) {
      const Vector3f way = station - disc.center;
      return std::abs(disc.normal.dot(way)) >= model_.least_cosine * way.norm() &&
             caster_.is_visible(station, disc.center, slack);
    });
  }

  const World& world_;
  const RayCaster& caster_;
  const std::vector<Vector3d>& stations_;
  const SurveyModel& model_;
};

void survey_discs(const DiscSurveyor& surveyor, const std::vector<DiscBlock>& blocks,
                  std::uint64_t seed, WorkerPool& pool, io::PointCloud& cloud) {
  std::vector<std::vector<Vector3f>> parts(chunk_count(blocks.size(), kChunkBlocks));
  const auto work = [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    RandomStream noise(seed, "survey.disc_noise." + std::to_string(chunk));
    RandomStream keep(seed, "survey.disc_keep." + std::to_string(chunk));
    for (std::size_t i = begin; i < end; ++i) surveyor.add(blocks[i], noise, keep, parts[chunk]);
  };
  for_each_chunk(pool, blocks.size(), kChunkBlocks, work);
  for (const auto& part : parts) {
    cloud.points.insert(cloud.points.end(), part.begin(), part.end());
  }
}

}  // namespace

io::PointCloud survey(const World& world, const RayCaster& caster, const Route& route,
                      const SurveyModel& model, std::uint64_t seed, WorkerPool& pool) {
  const std::vector<Vector3d> stations = stations_along(route, model.height_m);
  std::vector<std::vector<Vector3f>> parts(chunk_count(world.triangles.size(), kChunkTriangles));
  const auto work = [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Surveyor surveyor(caster, stations, model, seed, std::to_string(chunk));
    for (std::size_t i = begin; i < end; ++i) {
      const auto& t = world.triangles[i];
      const auto corner = [&](int k) -> Vector3d { return world.vertices[t[k]].cast<double>(); };
      const double share = world.materials[world.material_of[i]].survey_return;
      surveyor.add(Facet(corner(0), corner(1), corner(2)), share);
    }
    parts[chunk] = std::move(surveyor.points);
  };
  for_each_chunk(pool, world.triangles.size(), kChunkTriangles, work);
  io::PointCloud cloud;
  for (const auto& part : parts) {
    cloud.points.insert(cloud.points.end(), part.begin(), part.end());
  }
  survey_discs({world, caster, stations, model}, blocks_of(world.discs), seed, pool, cloud);
  return cloud;
}

}  // namespace holdfast::simulation
