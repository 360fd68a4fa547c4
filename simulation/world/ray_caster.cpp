#include "simulation/world/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::simulation {

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
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(world.triangles.size());
  for (const auto& [a, b, c] : world.triangles) {
    const Eigen::Vector3f& from = world.vertices[a];
    normals.push_back((world.vertices[b] - from).cross(world.vertices[c] - from).normalized());
  }
  return normals;
}

}  // namespace

RayCaster::RayCaster(const World& world)
    : embree_(std::make_unique<Embree>()),
      material_of_(world.material_of),
      normals_(normals_of(world)) {
  // One thread builds the tree, so that it is the same tree every time.
  embree_->device = rtcNewDevice("threads=1");
  embree_->scene = rtcNewScene(embree_->device);
  // Robust: no ray slips through between two triangles that share an edge.
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry mesh = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               world.vertices.size()));
  for (const auto& v : world.vertices) vertices = std::copy_n(v.data(), 3, vertices);
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), world.triangles.size()));
  for (const auto& t : world.triangles) corners = std::copy_n(t.data(), 3, corners);
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(embree_->scene, mesh);
  rtcReleaseGeometry(mesh);
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
    hits.triangle[i] = met ? packet.hit.primID[i] : 0;
    hits.material[i] = met ? material_of_[packet.hit.primID[i]] : std::uint16_t{0};
  }
}

bool RayCaster::is_visible(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const {
  constexpr float kSlack = 0.002F;
  const Eigen::Vector3f way = to - from;
  const float length = way.norm();
  RTCRay ray{};
  ray.org_x = from.x();
  ray.org_y = from.y();
  ray.org_z = from.z();
  ray.dir_x = way.x() / length;
  ray.dir_y = way.y() / length;
  ray.dir_z = way.z() / length;
  ray.tfar = length - kSlack;
  ray.mask = ~0U;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar >= 0;  // Embree sets it to minus infinity when something stands between
}

}  // namespace holdfast::simulation
