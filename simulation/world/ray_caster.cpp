#include "simulation/world/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::simulation {
namespace {

constexpr unsigned kMesh = 0;  // Embree's numbers of the geometries
constexpr unsigned kDiscs = 1;

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t words,
              std::size_t count) {
  return static_cast<T*>(
      rtcSetNewGeometryBuffer(geometry, type, 0, format, words * sizeof(T), count));
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void attach_triangles(RTCDevice device, RTCScene scene, const World& world) {
  RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      new_buffer<float>(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3, world.vertices.size());
  for (const auto& v : world.vertices) vertices = std::copy_n(v.data(), 3, vertices);
  auto* corners = new_buffer<std::uint32_t>(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3,
                                            world.triangles.size());
  for (const auto& t : world.triangles) corners = std::copy_n(t.data(), 3, corners);
  attach(scene, mesh, kMesh);
}

void attach_discs(RTCDevice device, RTCScene scene, const std::vector<Disc>& discs) {
  RTCGeometry points = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* centers =
      new_buffer<float>(points, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4, discs.size());
  auto* normals =
      new_buffer<float>(points, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3, discs.size());
  for (const Disc& disc : discs) {
    centers = std::copy_n(disc.center.data(), 3, centers);
    *centers++ = disc.radius;
    normals = std::copy_n(disc.normal.data(), 3, normals);
  }
  attach(scene, points, kDiscs);
}

}  // namespace

Eigen::Vector3d normal_of(const World& world, std::size_t surface) {
  if (surface >= world.triangles.size()) {
    return world.discs[surface - world.triangles.size()].normal.cast<double>();
  }
  Eigen::Vector3d p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = world.vertices[world.triangles[surface][k]].cast<double>();
  }
  return (p[1] - p[0]).cross(p[2] - p[0]).normalized();
}

struct RayCaster::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

std::vector<Eigen::Vector3f> normals_of(const World& world) {
  std::vector<Eigen::Vector3f> normals(world.triangles.size() + world.discs.size());
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = normal_of(world, i).cast<float>();
  return normals;
}

}  // namespace

RayCaster::RayCaster(const World& world)
    : embree_(std::make_unique<Embree>()),
      material_of_(world.material_of),
      first_disc_(static_cast<std::uint32_t>(world.triangles.size())),
      normals_(normals_of(world)) {
  for (const Disc& disc : world.discs) material_of_.push_back(disc.material);
  // One thread builds the tree, so that it is the same tree every time.
  embree_->device = rtcNewDevice("threads=1");
  embree_->scene = rtcNewScene(embree_->device);
  // Robust: no ray slips through between two triangles that share an edge.
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  if (!world.triangles.empty()) attach_triangles(embree_->device, embree_->scene, world);
  if (!world.discs.empty()) attach_discs(embree_->device, embree_->scene, world.discs);
  rtcCommitScene(embree_->scene);
}

RayCaster::~RayCaster() = default;

void RayCaster::cast(const RayPacket& rays, float min_range, float max_range,
                     HitPacket& hits) const {
  constexpr int kSize = RayPacket::kSize;
  RTCRayHit8 packet;
  for (int i = 0; i < kSize; ++i) {
    packet.ray.org_x[i] = rays.x[i];
    packet.ray.org_y[i] = rays.y[i];
    packet.ray.org_z[i] = rays.z[i];
    packet.ray.dir_x[i] = rays.dx[i];
    packet.ray.dir_y[i] = rays.dy[i];
    packet.ray.dir_z[i] = rays.dz[i];
    packet.ray.tnear[i] = min_range;
    packet.ray.tfar[i] = max_range;
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  alignas(32) static constexpr int kAll[kSize] = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(kAll, embree_->scene, &context, &packet);
  for (int i = 0; i < kSize; ++i) {
    const bool met = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    const float nx = packet.hit.Ng_x[i];
    const float ny = packet.hit.Ng_y[i];
    const float nz = packet.hit.Ng_z[i];
    const float dot = nx * rays.dx[i] + ny * rays.dy[i] + nz * rays.dz[i];
    hits.range[i] = met ? packet.ray.tfar[i] : std::numeric_limits<float>::infinity();
    hits.cos_incidence[i] = met ? std::abs(dot) / std::sqrt(nx * nx + ny * ny + nz * nz) : 0;
    const std::uint32_t before = packet.hit.geomID[i] == kDiscs ? first_disc_ : 0;
    hits.triangle[i] = met ? before + packet.hit.primID[i] : 0;
    hits.material[i] = met ? material_of_[hits.triangle[i]] : std::uint16_t{0};
  }
}

bool RayCaster::is_visible(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                           float slack) const {
  const Eigen::Vector3f way = to - from;
  const float length = way.norm();
  RTCRay ray{};
  ray.org_x = from.x();
  ray.org_y = from.y();
  ray.org_z = from.z();
  ray.dir_x = way.x() / length;
  ray.dir_y = way.y() / length;
  ray.dir_z = way.z() / length;
  ray.tfar = length - slack;
  ray.mask = ~0U;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar >= 0;  // Embree sets it to minus infinity when something stands between
}

}  // namespace holdfast::simulation
