// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "study/picture/camera.h"
#include "study/picture/overlay.h"
#include "study/picture/shading.h"

namespace phalanx {
namespace picture {
namespace {

constexpr int kObjectPart = kSegments;
constexpr int kLevel = 4;               // each mesh edge is drawn as this many
constexpr float kLeastGhost = 0.8e-3F;  // a segment whose HCP is nearer to its GDP than this has no ghost [m]
constexpr double kArrowAtFull = 0.038;  // length of the arrow of the full force [m]
constexpr double kShaft = 1.1e-3;       // arrows' radius [m]
const Vec3f kObjectAlbedo(0.075F, 0.27F, 0.30F);
const Vec3f kGhost(0.20F, 0.42F, 0.92F);
const Vec3f kArrow(0.025F, 0.03F, 0.05F);

/// How far the segment's far end and origin are apart between the two hands.
double ghost_distance(const Snapshot& snapshot, std::size_t s) {
  const Vec3 tip(0.0, 0.0, -0.03);
  return std::max((snapshot.hcp_pose[s].p - snapshot.gdp_pose[s].p).norm(),
                  (snapshot.hcp_pose[s] * tip - snapshot.gdp_pose[s] * tip).norm());
}

double rounded_up(double force) {
  const double power = std::pow(10.0, std::floor(std::log10(force)));
  for (const double step : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (force <= step * power * (1.0 + 1e-9)) return step * power;
  }
  return 10.0 * power;
}

struct Contents {
  RenderMesh solid, ghost, arrows;
  std::vector<Sight> contacts;
  std::array<Material, kSegments + 1> material;
  std::array<Pose, kSegments> pose;  ///< X_WS of the shown hand
  double full_force = 0.0;
};

/// The tint of the neighbouring segments runs into a segment's own within this distance of their joint [m]:
/// their meshes overlap there and a hard border would come out ragged.
constexpr float kBlend = 5e-3F;

/// Share of the segment beyond a joint at `beyond` [m] past it along the bone.
float share_beyond(float beyond) {
  const float t = std::clamp(0.5F + 0.5F * beyond / kBlend, 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

Contents collect(const SegmentMeshes& hand, const TriangleMesh& object, const Snapshot& snapshot,
                 double full_force) {
  Contents contents;
  double peak = 0.0;
  for (const SegmentSnapshot& segment : snapshot.segment) peak = std::max(peak, segment.force);
  contents.full_force = full_force > 0.0 ? full_force : peak > 0.0 ? rounded_up(peak) : 0.0;
  for (std::size_t s = 0; s < kSegments; ++s) {
    const auto part = static_cast<int>(s);
    const SegmentSnapshot& segment = snapshot.segment[s];
    append_curved(contents.solid, hand[s], snapshot.gdp_pose[s], part, kLevel);
    if (ghost_distance(snapshot, s) > static_cast<double>(kLeastGhost)) {
      append_curved(contents.ghost, hand[s], snapshot.hcp_pose[s], part, kLevel);
    }
    const double share = contents.full_force > 0.0 ? segment.force / contents.full_force : 0.0;
    contents.pose[s] = snapshot.gdp_pose[s];
    contents.material[s] = {.albedo = force_colour(static_cast<float>(share)), .gloss = 0.35F};
    if (!(segment.force > 0.0)) continue;
    append_arrow(contents.arrows, segment.point, segment.normal, kArrowAtFull * share, kShaft, part);
    append_ball(contents.arrows, segment.point, 1.9 * kShaft, part);
    contents.contacts.push_back({.point = segment.point.cast<float>(),
                                 .normal = segment.normal.cast<float>(),
                                 .weight = static_cast<float>(segment.force)});
  }
  append_curved(contents.solid, object, {}, kObjectPart, kLevel);
  contents.material[kObjectPart] = {.albedo = kObjectAlbedo, .gloss = 1.0F};
  return contents;
}

/// Across the palm, from the little finger's knuckle to the index finger's; so it is for either hand.
Vec3f thumb_side(const std::array<Pose, kSegments>& pose) {
  const auto knuckle = [&](int digit) { return pose[static_cast<std::size_t>(segment_index(digit, 0))].p; };
  const Vec3 across = knuckle(1) - knuckle(kDigits - 1);
  return across.stableNormalized().cast<float>();
}

class Renderer {
 public:
  Renderer(Contents contents, const PictureOptions& options)
      : options_(options),
        device_(make_device()),
        material_(contents.material),
        pose_(contents.pose),
        full_force_(contents.full_force),
        solid_(device_.get(), std::move(contents.solid)),
        ghost_(device_.get(), std::move(contents.ghost)),
        arrows_(device_.get(), std::move(contents.arrows)),
        camera_(choose_camera(solid_, {&ghost_.mesh(), &arrows_.mesh()}, contents.contacts,
                              thumb_side(contents.pose), options.width, options.height)) {
    float low = 1e9F, high = -1e9F;
    for (const Vec3f& v : solid_.mesh().vertices) {
      low = std::min(low, v.z());
      high = std::max(high, v.z());
    }
    // The key light stands to the camera's left, above and a little behind it.
    const Vec3f level(camera_.forward.x(), camera_.forward.y(), 0.0F);
    studio_ = {
        .key_direction =
            (-0.75F * camera_.right - 0.55F * level.normalized() + 1.15F * Vec3f::UnitZ()).normalized(),
        .floor_z = low - 1e-4F,
        .ambient_reach = 0.5F * (high - low)};
  }

  Image render() {
    canvas_ = {.width = options_.width,
               .height = options_.height,
               .pixel = std::vector<Vec3f>(static_cast<std::size_t>(options_.width) *
                                           static_cast<std::size_t>(options_.height))};
    std::atomic<int> next_row{0};
    const auto work = [&] {
      for (int y = next_row++; y < options_.height; y = next_row++) {
        for (int x = 0; x < options_.width; ++x) pixel(x, y);
      }
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back(work);
    work();
    threads.clear();
    if (options_.force_scale && full_force_ > 0.0) draw_force_scale(canvas_, full_force_);
    return developed();
  }

 private:
  [[nodiscard]] Vec3f background(float y) const {
    const float t = y / static_cast<float>(options_.height);
    return (1.0F - t) * Vec3f(0.71F, 0.76F, 0.82F) + t * Vec3f(0.90F, 0.91F, 0.915F);
  }

  void pixel(int x, int y) {
    const auto index = static_cast<std::uint32_t>(y * options_.width + x);
    const auto n = static_cast<std::uint32_t>(options_.samples);
    Vec3f sum = Vec3f::Zero();
    for (std::uint32_t i = 0; i < n * n; ++i) {
      Sampler sampler(index, i, n * n);
      const Eigen::Vector2f jitter = sampler.next();
      const float sx =
          static_cast<float>(x) + (static_cast<float>(i % n) + jitter.x()) / static_cast<float>(n);
      const float sy =
          static_cast<float>(y) + (static_cast<float>(i / n) + jitter.y()) / static_cast<float>(n);
      sum += sample(camera_.ray(sx, sy), sy, sampler).cwiseMin(1.6F);
    }
    canvas_.pixel[index] = sum / static_cast<float>(n * n);
  }

  [[nodiscard]] Vec3f sample(const Ray& ray, float y, Sampler& sampler) const {
    const auto hit = solid_.closest(ray);
    Vec3f colour;
    if (hit) {
      const Vec3f point = ray.origin + hit->distance * ray.direction;
      colour = shade(solid_, studio_, point, *hit, ray.direction, material_at(hit->part, point), sampler);
    } else {
      colour = background(y) * floor_share(ray, sampler);
    }
    if (const auto ghost = ghost_.closest(ray)) {
      const float edge = 1.0F - std::abs(ghost->normal.dot(ray.direction));
      float cover = 0.13F + 0.60F * edge * edge * edge;
      if (hit) {
        // Where the two hands all but coincide the ghost fades out; inside the object it stays as a hint.
        const float gap = (hit->distance - ghost->distance) / kLeastGhost;
        cover *= gap < 0.0F ? (hit->part == kObjectPart ? 0.30F : 0.0F) : std::min(1.0F, 0.4F * gap);
      }
      colour += cover * (kGhost - colour);
    }
    if (const auto arrow = arrows_.closest(ray)) {
      const bool in_front = !hit || arrow->distance < hit->distance;
      const float lit = 0.6F + 0.8F * std::max(0.0F, arrow->normal.dot(studio_.key_direction));
      colour += (in_front ? 1.0F : 0.50F) * (kArrow * lit - colour);
    }
    return colour;
  }

  /// How far `point` is beyond the joint between a digit's segments s and s + 1, along the mean of their
  /// bones [m].
  [[nodiscard]] float beyond_joint(std::size_t s, const Vec3f& point) const {
    const auto along = [&](std::size_t k) {
      return static_cast<float>(-(pose_[k].inverse() * point.cast<double>()).z());
    };
    const auto length = static_cast<float>((pose_[s + 1].p - pose_[s].p).norm());
    return 0.5F * (along(s) - length + along(s + 1));
  }

  [[nodiscard]] Material material_at(int part, const Vec3f& point) const {
    const auto s = static_cast<std::size_t>(part);
    Material material = material_[s];
    if (part >= kPalm) return material;
    const Vec3f own = material.albedo;
    if (part % kSegmentsPerDigit > 0) {
      material.albedo += (1.0F - share_beyond(beyond_joint(s - 1, point))) * (material_[s - 1].albedo - own);
    }
    if (part % kSegmentsPerDigit < kSegmentsPerDigit - 1) {
      material.albedo += share_beyond(beyond_joint(s, point)) * (material_[s + 1].albedo - own);
    }
    return material;
  }

  [[nodiscard]] float floor_share(const Ray& ray, Sampler& sampler) const {
    if (ray.direction.z() > -1e-3F) return 1.0F;
    const float distance = (studio_.floor_z - ray.origin.z()) / ray.direction.z();
    if (distance <= 0.0F) return 1.0F;
    return floor_light(solid_, studio_, ray.origin + distance * ray.direction, sampler);
  }

  /// Exposure, a soft shoulder for the highlights, and sRGB.
  [[nodiscard]] Image developed() const {
    Image image{.width = options_.width, .height = options_.height, .rgb = {}};
    image.rgb.reserve(3 * canvas_.pixel.size());
    for (const Vec3f& pixel : canvas_.pixel) {
      for (int c = 0; c < 3; ++c) {
        float v = std::max(0.0F, pixel[c]);
        constexpr float kKnee = 0.8F;
        if (v > kKnee) v = kKnee + (1.0F - kKnee) * (1.0F - std::exp(-(v - kKnee) / (1.0F - kKnee)));
        const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
        image.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(s, 0.0F, 1.0F))));
      }
    }
    return image;
  }

  PictureOptions options_;
  Device device_;
  std::array<Material, kSegments + 1> material_;
  std::array<Pose, kSegments> pose_;
  double full_force_;
  RayScene solid_, ghost_, arrows_;
  Camera camera_;
  Studio studio_;
  Canvas canvas_;
};

}  // namespace
}  // namespace picture

Image render_picture(const SegmentMeshes& hand, const TriangleMesh& object, const Snapshot& snapshot,
                     const PictureOptions& options) {
  if (std::min(options.width, options.height) < 16 || std::max(options.width, options.height) > 16384) {
    throw std::invalid_argument(fmt::format("picture of {} x {} pixels: each must be from 16 to 16384",
                                            options.width, options.height));
  }
  if (options.samples < 1 || options.samples > 32) {
    throw std::invalid_argument(
        fmt::format("picture with {} samples: must be from 1 to 32", options.samples));
  }
  return picture::Renderer(picture::collect(hand, object, snapshot, options.full_force), options).render();
}

}  // namespace phalanx
