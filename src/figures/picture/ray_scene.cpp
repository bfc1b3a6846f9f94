// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/ray_scene.h"

#include <cstring>
#include <stdexcept>

namespace phalanx::picture {
namespace {

RTCRay to_embree(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x();
  r.org_y = ray.origin.y();
  r.org_z = ray.origin.z();
  r.dir_x = ray.direction.x();
  r.dir_y = ray.direction.y();
  r.dir_z = ray.direction.z();
  r.tnear = ray.near;
  r.tfar = ray.far;
  r.mask = 0xFFFFFFFFU;
  return r;
}

}  // namespace

Device make_device() {
  Device device(rtcNewDevice("threads=1,set_affinity=0"));
  if (!device) throw std::runtime_error("picture: the ray tracer (Embree) cannot start");
  return device;
}

RayScene::RayScene(RTCDevice device, RenderMesh mesh) : mesh_(std::move(mesh)), scene_(rtcNewScene(device)) {
  if (!mesh_.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vec3f), mesh_.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh_.triangles[0]), mesh_.triangles.size());
    if (vertices == nullptr || indices == nullptr) throw std::runtime_error("picture: out of memory");
    std::memcpy(vertices, mesh_.vertices.data(), mesh_.vertices.size() * sizeof(Vec3f));
    std::memcpy(indices, mesh_.triangles.data(), mesh_.triangles.size() * sizeof(mesh_.triangles[0]));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
}

std::optional<Hit> RayScene::closest(const Ray& ray) const {
  if (empty()) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = to_embree(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const std::size_t triangle = query.hit.primID;
  const auto interpolated = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) -> Vec3f {
    return (1.0F - query.hit.u - query.hit.v) * a + query.hit.u * b + query.hit.v * c;
  };
  const auto& n = mesh_.normals[triangle];
  const auto& v = mesh_.triangles[triangle];
  Hit hit{.distance = query.ray.tfar,
          .part = mesh_.part[triangle],
          .albedo = interpolated(mesh_.albedo[v[0]], mesh_.albedo[v[1]], mesh_.albedo[v[2]]),
          .normal = interpolated(n[0], n[1], n[2]).normalized(),
          .geometric = Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized()};
  if (hit.geometric.dot(ray.direction) > 0.0F) hit.geometric = -hit.geometric;
  return hit;
}

bool RayScene::occluded(const Ray& ray) const {
  if (empty()) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = to_embree(ray);
  rtcOccluded1(scene_.get(), &context, &query);
  return query.tfar < 0.0F;
}

}  // namespace phalanx::picture
