// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "figures/picture/ray_scene.h"

namespace phalanx::picture {

/// Surface of a part.
struct Material {
  Vec3f albedo;
  float gloss;  ///< strength of the highlight; 0: matt
};

/// Numbers in [0, 1) that depend only on the pixel and the sample. They form a rotated R2 lattice, which
/// spreads a pixel's samples evenly.
class Sampler {
 public:
  Sampler(std::uint32_t pixel, std::uint32_t sample, std::uint32_t count) noexcept
      : pixel_(pixel), sample_(sample), count_(count) {}
  /// @returns the next pair.
  [[nodiscard]] Eigen::Vector2f next() noexcept;

 private:
  std::uint32_t pixel_, sample_, count_, dimension_ = 0;
};

/// The lights: a large soft key light, a bright sky, and a floor that only shows shadows.
struct Studio {
  Vec3f key_direction;  ///< unit vector towards the light
  float floor_z;        ///< [m]
  float ambient_reach;  ///< largest distance of ambient occlusion [m]
};

/// @returns a unit vector about `axis`, cosine-distributed.
[[nodiscard]] Vec3f cosine_direction(const Vec3f& axis, const Eigen::Vector2f& u);

/// @returns the light that leaves the point towards the eye.
[[nodiscard]] Vec3f shade(const RayScene& scene, const Studio& studio, const Vec3f& point, const Hit& hit,
                          const Vec3f& view, const Material& material, Sampler& sampler);

/// @returns the part of the light that reaches the floor at `point`; 1 if nothing is in the way.
[[nodiscard]] float floor_light(const RayScene& scene, const Studio& studio, const Vec3f& point,
                                Sampler& sampler);

}  // namespace phalanx::picture
