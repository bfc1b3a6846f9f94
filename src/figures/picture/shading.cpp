// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phalanx::picture {
namespace {

constexpr float kSkin = 2e-5F;       // distance from the surface at which rays start [m]
constexpr float kKeySpread = 0.16F;  // radius of the key light, seen from the scene [rad]
const Vec3f kKeyColour(0.98F, 0.93F, 0.86F);
const Vec3f kSkyColour(0.50F, 0.545F, 0.62F);
const Vec3f kFloorBounce(0.40F, 0.385F, 0.37F);

std::uint32_t hashed(std::uint32_t x) noexcept {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  return x ^ (x >> 16U);
}

float unit_float(std::uint32_t x) noexcept { return static_cast<float>(x >> 8U) * 0x1p-24F; }

/// @returns a direction in a cone about the key light's.
Vec3f key_sample(const Studio& studio, const Eigen::Vector2f& u) {
  const float r = kKeySpread * std::sqrt(u.x());
  const float a = 2.0F * std::numbers::pi_v<float> * u.y();
  const Vec3f e1 = studio.key_direction.unitOrthogonal();
  const Vec3f e2 = studio.key_direction.cross(e1);
  return (studio.key_direction + r * std::cos(a) * e1 + r * std::sin(a) * e2).normalized();
}

Vec3f sky(const Vec3f& direction) {
  const float t = 0.5F + 0.5F * direction.z();
  return t * kSkyColour + (1.0F - t) * kFloorBounce;
}

}  // namespace

Eigen::Vector2f Sampler::next() noexcept {
  const std::uint32_t seed = hashed(pixel_ * 31U + dimension_++);
  // Each pair has another order of the samples, so that pairs are not correlated. R2 after M. Roberts (2018).
  const std::uint32_t order = (sample_ + hashed(seed ^ 0x9e3779b9U) % count_) % count_;
  const float x = unit_float(hashed(seed)) + static_cast<float>(order) * 0.7548776662F;
  const float y = unit_float(hashed(seed + 0x51ed270bU)) + static_cast<float>(order) * 0.5698402910F;
  return {x - std::floor(x), y - std::floor(y)};
}

Vec3f cosine_direction(const Vec3f& axis, const Eigen::Vector2f& u) {
  const float r = std::sqrt(u.x());
  const float a = 2.0F * std::numbers::pi_v<float> * u.y();
  const Vec3f e1 = axis.unitOrthogonal();
  const Vec3f e2 = axis.cross(e1);
  return r * std::cos(a) * e1 + r * std::sin(a) * e2 + std::sqrt(std::max(0.0F, 1.0F - u.x())) * axis;
}

Vec3f shade(const RayScene& scene, const Studio& studio, const Vec3f& point, const Hit& hit,
            const Vec3f& view, const Material& material, Sampler& sampler) {
  Vec3f normal = hit.normal;
  if (normal.dot(hit.geometric) < 0.0F) normal = -normal;
  // Near a silhouette the interpolated normal may point away from the eye, and would mirror the whole sky.
  constexpr float kLeastFacing = 0.05F;
  if (const float facing_eye = -view.dot(normal); facing_eye < kLeastFacing)
    normal = (normal - (kLeastFacing - facing_eye) * view).normalized();
  const Vec3f start = point + kSkin * hit.geometric;

  const Vec3f to_key = key_sample(studio, sampler.next());
  const float facing = normal.dot(to_key);
  float key = 0.0F;
  if (facing > 0.0F && !scene.occluded({.origin = start, .direction = to_key})) key = facing;

  const Vec3f ambient_direction = cosine_direction(normal, sampler.next());
  const Ray ambient_ray{.origin = start, .direction = ambient_direction, .far = studio.ambient_reach};
  Vec3f ambient = sky(ambient_direction);
  // Surfaces that hide the sky reflect some light themselves: no corner is black.
  if (ambient_direction.dot(hit.geometric) <= 0.0F || scene.occluded(ambient_ray)) {
    ambient = 0.30F * material.albedo.cwiseProduct(ambient) + Vec3f::Constant(0.03F);
  }
  Vec3f light = material.albedo.cwiseProduct(kKeyColour * key + 0.92F * ambient);

  const Vec3f half = (to_key - view).normalized();
  const float fresnel = 0.04F + 0.96F * std::pow(1.0F - std::clamp(-view.dot(normal), 0.0F, 1.0F), 5.0F);
  const float sharpness = 12.0F + 90.0F * material.gloss;
  const float highlight =
      key > 0.0F ? std::pow(std::max(0.0F, half.dot(normal)), sharpness) * (sharpness + 8.0F) / 60.0F : 0.0F;
  const Vec3f mirrored = view - 2.0F * view.dot(normal) * normal;
  Vec3f reflected = sky(mirrored);
  if (mirrored.dot(hit.geometric) <= 0.0F ||
      scene.occluded({.origin = start, .direction = mirrored, .far = studio.ambient_reach})) {
    reflected = 0.30F * material.albedo.cwiseProduct(reflected);
  } else if (mirrored.z() < 0.0F) {
    reflected *= 1.0F + 0.6F * mirrored.z();  // the floor under an object is in its shadow
  }
  light += material.gloss * (0.16F * highlight * kKeyColour + 0.7F * fresnel * reflected);
  return light;
}

float floor_light(const RayScene& scene, const Studio& studio, const Vec3f& point, Sampler& sampler) {
  const Vec3f start = point + kSkin * Vec3f::UnitZ();
  const Vec3f to_key = key_sample(studio, sampler.next());
  const float key = scene.occluded({.origin = start, .direction = to_key}) ? 0.0F : 1.0F;
  const Ray ambient_ray{.origin = start, .direction = cosine_direction(Vec3f::UnitZ(), sampler.next())};
  const float ambient = scene.occluded(ambient_ray) ? 0.15F : 1.0F;
  return 0.45F * key + 0.55F * ambient;
}

}  // namespace phalanx::picture
