// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "study/picture/ray_scene.h"

namespace phalanx::picture {

struct Material {
  Vec3f albedo;
  float gloss;  ///< strength of the highlight, 0 matt
};

/// Numbers in [0, 1) that only depend on the pixel and the sample: a rotated R2 lattice, so that a pixel's
/// samples are spread evenly.
class Sampler {
 public:
  Sampler(std::uint32_t pixel, std::uint32_t sample, std::uint32_t count) noexcept
      : pixel_(pixel), sample_(sample), count_(count) {}
  /// The next pair.
  [[nodiscard]] Eigen::Vector2f next() noexcept;

 private:
  std::uint32_t pixel_, sample_, count_, dimension_ = 0;
};

/// The studio: a large soft key light, a bright sky, a floor that only catches shadows.
struct Studio {
  Vec3f key_direction;  ///< towards the light, unit
  float floor_z;        ///< [m]
  float ambient_reach;  ///< how far ambient occlusion looks [m]
};

/// A unit vector about `axis`, cosine-distributed.
[[nodiscard]] Vec3f cosine_direction(const Vec3f& axis, const Eigen::Vector2f& u);

/// Light that leaves the point towards the eye.
[[nodiscard]] Vec3f shade(const RayScene& scene, const Studio& studio, const Vec3f& point, const Hit& hit,
                          const Vec3f& view, const Material& material, Sampler& sampler);

/// How much of the studio's light reaches the floor at `point`, 1 where nothing is in the way.
[[nodiscard]] float floor_light(const RayScene& scene, const Studio& studio, const Vec3f& point,
                                Sampler& sampler);

}  // namespace phalanx::picture
