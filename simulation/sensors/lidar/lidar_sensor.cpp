#include "simulation/sensors/lidar/lidar_sensor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "holdfast/core/random.hpp"
#include "simulation/sensors/lidar/beam_errors.hpp"
#include "simulation/sensors/lidar/scan_pattern.hpp"

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::size_t kChunkColumns = 40;
constexpr std::uint16_t kWalker = std::numeric_limits<std::uint16_t>::max();

bool is_blind(const std::vector<TimeSpan>& spans, TimeNs t) {
  return std::any_of(spans.begin(), spans.end(),
                     [t](const TimeSpan& span) { return span.contains(t); });
}

/// A ball that holds a person's capsules.
struct Ball {
  Vector3d center = Vector3d::Zero();
  double radius = 0;
};

Ball ball_around(const Capsule* shapes, std::size_t count) {
  Ball ball;
  for (std::size_t i = 0; i < count; ++i) ball.center += 0.5 * (shapes[i].a + shapes[i].b);
  ball.center /= static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double reach =
        std::max((shapes[i].a - ball.center).norm(), (shapes[i].b - ball.center).norm());
    ball.radius = std::max(ball.radius, reach + shapes[i].radius);
  }
  return ball;
}

}  // namespace

/// A run of consecutive columns: the unit of parallel work.
struct LidarSensor::Chunk {
  std::size_t scan = 0;
  std::size_t index = 0;
  std::size_t begin = 0;  ///< first column
  std::size_t end = 0;
  TimeNs scan_begin = 0;
  std::vector<ColumnPose> poses;        ///< [column]
  std::vector<float> range;             ///< [column][beam], infinite without a hit
  std::vector<float> cos_incidence;     ///< likewise
  std::vector<std::uint16_t> material;  ///< likewise
  std::vector<ScanPoint> points;        ///< time offsets from the start of the revolution
  Beams beams;                          ///< with faults or weather
  std::vector<ReturnKind> kinds;        ///< of the points; likewise

  std::size_t columns() const { return end - begin; }
  void keep_ray(std::size_t column, std::size_t beam, const Vector3f& origin, const Vector3f& d) {
    const std::size_t at = (column - begin) * beams.per_column + beam;
    beams.origin[at] = origin;
    beams.direction[at] = d;
  }
  RandomStream stream(std::uint64_t seed, const char* purpose) const {
    return {seed, std::string(purpose) + "." + std::to_string(scan) + "." + std::to_string(index)};
  }
};

LidarSensor::LidarSensor(const LidarModel& model, std::uint64_t seed, const Weather& weather)
    : model_(model),
      seed_(seed),
      returns_(ReturnModel::create(model, weather)),
      column_times_(column_times(model)) {
  assert(!model.beams.empty() && model.columns > 0);
  look_about(0);
}

/// The directions of a frame, and where its points are to lie if beams point elsewhere.
void LidarSensor::look_about(std::size_t frame) {
  frame_ = frame;
  directions_ = ray_directions(model_, frame);
  const TrueDirections truly(model_);
  if (truly.as_stated()) return;
  stated_ = directions_;
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const std::uint16_t ring = model_.beams[i % model_.beams.size()].ring;
    directions_[i] = truly.of(stated_[i].cast<double>(), ring).cast<float>();
  }
}

/// Where the LiDAR puts what it measures at `range`; `ray` is [column][beam].
Vector3d LidarSensor::point_at(double range, std::size_t ray) const {
  const double measured = range + model_.beams[ray % model_.beams.size()].error.range_m;
  return measured * (stated_.empty() ? directions_ : stated_)[ray].cast<double>();
}

TimeNs LidarSensor::fire_time(std::size_t column, std::size_t beam) const {
  return column_times_[column] + model_.beams[beam].fire_offset;
}

LidarSensor::ColumnPose LidarSensor::column_pose(const Drive& drive, TimeNs t) const {
  const MotionState body = drive.at(t);
  const SE3 T_map_lidar = body.T_map_body * model_.T_body_lidar;
  const Eigen::Matrix3d R_map_body = body.T_map_body.rotation.toRotationMatrix();
  const Eigen::Matrix3d R_map_lidar = T_map_lidar.rotation.toRotationMatrix();
  const Vector3d omega_lidar = model_.T_body_lidar.rotation.conjugate() * body.omega_body;
  const Vector3d lever_velocity =
      R_map_body * body.omega_body.cross(model_.T_body_lidar.translation);
  return {T_map_lidar.translation.cast<float>(), (body.v_map + lever_velocity).cast<float>(),
          R_map_lidar.cast<float>(), (R_map_lidar * so3::hat(omega_lidar)).cast<float>()};
}

// Within a column (some 40 us) the pose is continued to first order from the exact pose and rates
// at the column's start; what is left out is below 1e-8 of a radian and of a metre at 3 rad/s and
// 10 g.
void LidarSensor::cast_chunk(Chunk& chunk, const Surroundings& around) const {
  const std::size_t beams = model_.beams.size();
  const auto min_range = static_cast<float>(model_.min_range_m);
  const auto max_range = static_cast<float>(model_.max_range_m);
  RayPacket rays;
  HitPacket hits;
  for (std::size_t first = chunk.begin; first < chunk.end; first += RayPacket::kSize) {
    for (std::size_t beam = 0; beam < beams; ++beam) {
      const auto since = static_cast<float>(to_seconds(model_.beams[beam].fire_offset));
      for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
        const std::size_t column = std::min(first + lane, chunk.end - 1);
        const ColumnPose& pose = chunk.poses[column - chunk.begin];
        const Vector3f& direction = directions_[column * beams + beam];
        const Vector3f origin = pose.origin + since * pose.velocity;
        const Vector3f d = pose.rotation * direction + since * (pose.rotation_rate * direction);
        rays.x[lane] = origin.x();
        rays.y[lane] = origin.y();
        rays.z[lane] = origin.z();
        rays.dx[lane] = d.x();
        rays.dy[lane] = d.y();
        rays.dz[lane] = d.z();
        if (returns_) chunk.keep_ray(column, beam, origin, d);
      }
      around.caster.cast(rays, min_range, max_range, hits);
      for (std::size_t lane = 0; lane < RayPacket::kSize && first + lane < chunk.end; ++lane) {
        const std::size_t at = (first + lane - chunk.begin) * beams + beam;
        chunk.range[at] = hits.range[lane];
        chunk.cos_incidence[at] = hits.cos_incidence[lane];
        chunk.material[at] = hits.material[lane];
        if (returns_) chunk.beams.triangle[at] = hits.triangle[lane];
      }
    }
  }
}

/// Whether rays of the chunk may meet a ball.
bool LidarSensor::may_see(const Chunk& chunk, const Vector3d& center, double radius) const {
  const ColumnPose& middle = chunk.poses[chunk.columns() / 2];
  const Vector3f heading = directions_[(chunk.begin + chunk.columns() / 2) * model_.beams.size()];
  const double half_width =
      std::numbers::pi * static_cast<double>(chunk.columns() + 2) / model_.columns;
  const Vector3f there = middle.rotation.transpose() * (center.cast<float>() - middle.origin);
  const double distance = there.head<2>().norm();
  const double azimuth = std::atan2(there.y(), there.x()) - std::atan2(heading.y(), heading.x());
  const double ball_width = distance > radius ? std::asin(radius / distance) : 4;
  return std::abs(std::remainder(azimuth, 2 * std::numbers::pi)) <= half_width + ball_width;
}

/// Puts people in front of what the static world returned. A ray sees them where they are at its
/// own time: their shapes are taken at the middle of the chunk and move on with their velocity.
void LidarSensor::cast_walkers(Chunk& chunk, const Surroundings& around) const {
  const std::size_t beams = model_.beams.size();
  const TimeNs middle =
      chunk.scan_begin + (column_times_[chunk.begin] + column_times_[chunk.end - 1]) / 2;
  std::vector<Capsule> shapes;
  around.walkers.shapes_at(middle, shapes);
  for (std::size_t first = 0; first < shapes.size(); first += Walkers::kCapsulesEach) {
    const Ball ball = ball_around(&shapes[first], Walkers::kCapsulesEach);
    if (!may_see(chunk, ball.center, ball.radius)) continue;
    for (std::size_t i = 0; i < chunk.range.size(); ++i) {
      const std::size_t column = i / beams;
      const TimeNs fired = fire_time(chunk.begin + column, i % beams) + chunk.scan_begin;
      const auto since_column = static_cast<float>(to_seconds(model_.beams[i % beams].fire_offset));
      const ColumnPose& pose = chunk.poses[column];
      const Vector3d origin = (pose.origin + since_column * pose.velocity).cast<double>();
      const Vector3d direction =
          (pose.rotation * directions_[chunk.begin * beams + i]).cast<double>();
      const double since_middle = to_seconds(fired - middle);
      for (std::size_t k = first; k < first + Walkers::kCapsulesEach; ++k) {
        const double max_range = std::min<double>(chunk.range[i], model_.max_range_m);
        CapsuleHit hit{};
        const Vector3d origin_then = origin - since_middle * shapes[k].velocity;
        if (!intersect(shapes[k], origin_then, direction, model_.min_range_m, max_range, hit)) {
          continue;
        }
        chunk.range[i] = static_cast<float>(hit.range);
        chunk.cos_incidence[i] = static_cast<float>(hit.cos_incidence);
        chunk.material[i] = kWalker;
      }
    }
  }
}

/// Likewise with vehicles and whatever else moves as a rigid body.
void LidarSensor::cast_movers(Chunk& chunk, const Surroundings& around) const {
  const TimeNs middle =
      chunk.scan_begin + (column_times_[chunk.begin] + column_times_[chunk.end - 1]) / 2;
  for (std::size_t mover = 0; mover < around.movers.size(); ++mover) {
    const Vector3d center = around.movers.at(mover, middle).T_map_body.translation;
    if (!may_see(chunk, center, around.movers.radius(mover))) continue;
    cast_mover(chunk, around.movers, mover, middle);
  }
}

void LidarSensor::cast_mover(Chunk& chunk, const Movers& movers, std::size_t mover,
                             TimeNs middle) const {
  const std::size_t beams = model_.beams.size();
  const MotionState state = movers.at(mover, middle);
  for (std::size_t i = 0; i < chunk.range.size(); ++i) {
    const std::size_t column = i / beams;
    const TimeNs fired = fire_time(chunk.begin + column, i % beams) + chunk.scan_begin;
    const auto since_column = static_cast<float>(to_seconds(model_.beams[i % beams].fire_offset));
    const ColumnPose& pose = chunk.poses[column];
    const Vector3f& direction = directions_[chunk.begin * beams + i];
    const Vector3f origin = pose.origin + since_column * pose.velocity;
    const Vector3f d = pose.rotation * direction + since_column * (pose.rotation_rate * direction);
    const double max_range = std::min<double>(chunk.range[i], model_.max_range_m);
    MoverHit hit;
    if (!movers.meets(mover, state, to_seconds(fired - middle), origin.cast<double>(),
                      d.cast<double>(), model_.min_range_m, max_range, hit)) {
      continue;
    }
    chunk.range[i] = static_cast<float>(hit.range);
    chunk.cos_incidence[i] = static_cast<float>(hit.cos_incidence);
    chunk.material[i] = hit.material;
  }
}

void LidarSensor::measure_chunk(Chunk& chunk, const Surroundings& around) const {
  const std::size_t beams = model_.beams.size();
  RandomStream returns = chunk.stream(seed_, "lidar.return");
  RandomStream noise = chunk.stream(seed_, "lidar.range_noise");
  for (std::size_t i = 0; i < chunk.range.size(); ++i) {
    // Drawn for every ray, so that what one ray meets does not change the noise of the others.
    const double chance = returns.uniform();
    const double error = model_.range_sigma_m * noise.normal();
    if (!std::isfinite(chunk.range[i])) continue;
    const std::size_t column = chunk.begin + i / beams;
    const std::size_t beam = i % beams;
    const TimeNs offset = fire_time(column, beam);
    const Material& material =
        chunk.material[i] == kWalker ? materials::kClothing : around.materials[chunk.material[i]];
    const double cos_incidence = chunk.cos_incidence[i];
    const bool returned = chance < material.return_probability(cos_incidence);
    if (!(returned || model_.keep_all_returns)) continue;
    if (is_blind(around.blind, chunk.scan_begin + offset)) continue;
    const double range = chunk.range[i] + error;
    const Vector3d point = point_at(range, column * beams + beam);
    const double intensity = std::round(255 * material.reflectivity * cos_incidence);
    chunk.points.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                            static_cast<float>(point.z()), static_cast<float>(intensity),
                            static_cast<std::int32_t>(offset), model_.beams[beam].ring});
  }
}

void LidarSensor::prepare_chunk(Chunk& chunk, const Surroundings& around) const {
  const std::size_t rays = chunk.columns() * model_.beams.size();
  for (std::size_t column = chunk.begin; column < chunk.end; ++column) {
    chunk.poses.push_back(column_pose(around.drive, chunk.scan_begin + column_times_[column]));
  }
  chunk.range.resize(rays);
  chunk.cos_incidence.resize(rays);
  chunk.material.resize(rays);
  if (!returns_) return;
  chunk.beams.per_column = model_.beams.size();
  chunk.beams.origin.resize(rays);
  chunk.beams.direction.resize(rays);
  chunk.beams.triangle.resize(rays);
}

/// What the axes of the beams met, in the order of firing, and what those of the columns next to
/// each chunk did.
void LidarSensor::keep_echoes(std::vector<Chunk>& chunks) const {
  for (Chunk& chunk : chunks) {
    for (std::size_t i = 0; i < chunk.range.size(); ++i) {
      chunk.beams.echoes.push_back(
          {chunk.range[i], chunk.cos_incidence[i], 1, chunk.material[i], ReturnKind::kSurface});
    }
  }
  const auto beams = static_cast<std::ptrdiff_t>(model_.beams.size());
  for (std::size_t i = 0; i + 1 < chunks.size(); ++i) {
    const std::vector<Echo>& here = chunks[i].beams.echoes;
    const std::vector<Echo>& next = chunks[i + 1].beams.echoes;
    chunks[i + 1].beams.before.assign(here.end() - beams, here.end());
    chunks[i].beams.after.assign(next.begin(), next.begin() + beams);
  }
}

void LidarSensor::measure_spoilt(Chunk& chunk, const Surroundings& around) const {
  const std::size_t beams = model_.beams.size();
  const Materials materials(around.materials);
  const auto stream = [&](const char* purpose) { return chunk.stream(seed_, purpose); };
  returns_->spoil(chunk.beams, around.caster, materials, stream);
  RandomStream noise = stream("lidar.range_noise");
  for (std::size_t i = 0; i < chunk.beams.echoes.size(); ++i) {
    const double drawn = noise.normal();
    const Echo& echo = chunk.beams.echoes[i];
    if (!echo.is_there()) continue;
    const std::size_t column = chunk.begin + i / beams;
    const std::size_t beam = i % beams;
    const TimeNs offset = fire_time(column, beam);
    if (is_blind(around.blind, chunk.scan_begin + offset)) continue;
    const double range = echo.range + range_sigma(model_, echo.range, echo.cos_incidence) * drawn;
    const Vector3d point = point_at(range, column * beams + beam);
    const double intensity = std::round(255 * returns_->brightness(echo, materials));
    chunk.points.push_back({static_cast<float>(point.x()), static_cast<float>(point.y()),
                            static_cast<float>(point.z()), static_cast<float>(intensity),
                            static_cast<std::int32_t>(offset), model_.beams[beam].ring});
    chunk.kinds.push_back(echo.kind);
  }
}

std::vector<LidarSensor::Chunk> LidarSensor::cast(std::size_t index, TimeNs begin,
                                                  const Surroundings& around,
                                                  WorkerPool& pool) const {
  std::vector<Chunk> chunks(chunk_count(column_times_.size(), kChunkColumns));
  const auto work = [&](std::size_t chunk_index, std::size_t first, std::size_t last) {
    Chunk& chunk = chunks[chunk_index];
    chunk.scan = index;
    chunk.index = chunk_index;
    chunk.begin = first;
    chunk.end = last;
    chunk.scan_begin = begin;
    prepare_chunk(chunk, around);
    cast_chunk(chunk, around);
    if (around.walkers.size() > 0) cast_walkers(chunk, around);
    cast_movers(chunk, around);
    if (!returns_) measure_chunk(chunk, around);
  };
  for_each_chunk(pool, column_times_.size(), kChunkColumns, work);
  if (!returns_) return chunks;
  // Edges are looked for across the borders of chunks: all must have been cast.
  keep_echoes(chunks);
  pool.run(chunks.size(), [&](std::size_t i) { measure_spoilt(chunks[i], around); });
  return chunks;
}

LidarSensor::Revolution LidarSensor::revolve_with_kinds(std::size_t index, TimeNs begin,
                                                        const Surroundings& around,
                                                        WorkerPool& pool) const {
  if (model_.rosette && frame_ != index) {
    LidarSensor later = *this;
    later.look_about(index);
    return later.revolve_with_kinds(index, begin, around, pool);
  }
  Revolution out;
  Scan& scan = out.scan;
  scan.has_ring = true;
  scan.has_point_times = true;
  scan.stamp = begin;
  scan.end_time = begin + model_.period;
  for (const Chunk& chunk : cast(index, begin, around, pool)) {
    scan.points.insert(scan.points.end(), chunk.points.begin(), chunk.points.end());
    out.kinds.insert(out.kinds.end(), chunk.kinds.begin(), chunk.kinds.end());
  }
  if (scan.points.empty()) return out;
  const std::int32_t first = scan.points.front().time_offset_ns;
  for (ScanPoint& point : scan.points) point.time_offset_ns -= first;
  scan.stamp = begin + first;
  scan.end_time = scan.stamp + scan.points.back().time_offset_ns;
  return out;
}

Scan LidarSensor::revolve(std::size_t index, TimeNs begin, const Surroundings& around,
                          WorkerPool& pool) const {
  return revolve_with_kinds(index, begin, around, pool).scan;
}

}  // namespace holdfast::simulation
