#include "simulation/aliases/range_image.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace holdfast::simulation {

using Eigen::Vector3d;

ImageRays ImageRays::over(double lowest, double highest, std::size_t rows, std::size_t columns,
                          double max_range_m) {
  assert(rows > 1 && columns % RayPacket::kSize == 0);
  ImageRays rays{{}, columns, max_range_m, {}};
  for (std::size_t row = 0; row < rows; ++row) {
    const double share = static_cast<double>(row) / static_cast<double>(rows - 1);
    rays.elevations.push_back(lowest + share * (highest - lowest));
    const double level = std::cos(rays.elevations.back());
    for (std::size_t column = 0; column < columns; ++column) {
      const double azimuth =
          2 * std::numbers::pi * static_cast<double>(column) / static_cast<double>(columns);
      rays.directions.emplace_back(level * std::cos(azimuth), level * std::sin(azimuth),
                                   std::sin(rays.elevations.back()));
    }
  }
  return rays;
}

RangeImage render(const RayCaster& caster, const ImageRays& rays, const SE3& T_map_image) {
  RangeImage image;
  image.range.resize(rays.size());
  image.surface.resize(rays.size());
  const auto nothing = static_cast<float>(2 * rays.max_range_m);
  const Eigen::Matrix3d R_map_image = T_map_image.rotation.toRotationMatrix();
  const Eigen::Vector3f origin = T_map_image.translation.cast<float>();
  RayPacket packet;
  packet.x.fill(origin.x());
  packet.y.fill(origin.y());
  packet.z.fill(origin.z());
  HitPacket hits;
  for (std::size_t first = 0; first < rays.size(); first += RayPacket::kSize) {
    for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
      const Vector3d direction = R_map_image * rays.direction(first + lane);
      packet.dx[lane] = static_cast<float>(direction.x());
      packet.dy[lane] = static_cast<float>(direction.y());
      packet.dz[lane] = static_cast<float>(direction.z());
    }
    caster.cast(packet, 0, static_cast<float>(rays.max_range_m), hits);
    for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
      image.range[first + lane] = std::isfinite(hits.range[lane]) ? hits.range[lane] : nothing;
      image.surface[first + lane] = hits.triangle[lane];
    }
  }
  return image;
}

}  // namespace holdfast::simulation
