// SPDX-License-Identifier: Apache-2.0
// A mesh in Embree's search tree.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <optional>

#include "figures/picture/render_mesh.h"

namespace phalanx::picture {

/// A ray with its range.
struct Ray {
  Vec3f origin;
  Vec3f direction;  ///< unit vector
  float near = 0.0F;
  float far = 1e9F;
};

/// Intersection of a ray with the mesh.
struct Hit {
  float distance;
  int part;
  Vec3f albedo;     ///< interpolated
  Vec3f normal;     ///< interpolated, unit, outward as in the mesh
  Vec3f geometric;  ///< normal of the flat triangle, unit, on the ray's side
};

struct ReleaseDevice {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;

/// Makes the Embree device. @throws std::runtime_error if Embree cannot start
[[nodiscard]] Device make_device();

/// Mesh with ray queries. Queries are const and may run in several threads at once.
class RayScene {
 public:
  RayScene(RTCDevice device, RenderMesh mesh);
  [[nodiscard]] bool empty() const noexcept { return mesh_.triangles.empty(); }
  [[nodiscard]] std::optional<Hit> closest(const Ray& ray) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;
  [[nodiscard]] const RenderMesh& mesh() const noexcept { return mesh_; }

 private:
  RenderMesh mesh_;
  std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

}  // namespace phalanx::picture
