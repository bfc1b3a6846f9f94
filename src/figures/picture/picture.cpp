// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "figures/picture/camera.h"
#include "figures/picture/drawn_hand.h"
#include "figures/picture/overlay.h"
#include "figures/picture/shading.h"

namespace phalanx {
namespace picture {
namespace {

constexpr int kObjectPart = kSegments;
constexpr float kHandGloss = 0.35F;
constexpr double kArrowAtFull = 0.038;  // length of the arrow of the full force [m]
constexpr double kShaft = 1.1e-3;       // radius of arrows [m]
const Vec3f kObjectAlbedo(0.075F, 0.27F, 0.30F);
const Vec3f kGhost(0.20F, 0.42F, 0.92F);
const Vec3f kArrow(0.025F, 0.03F, 0.05F);

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
  Vec3f thumb_side;
  double full_force = 0.0;
};

/// @returns the direction across the palm, from the little finger's knuckle to the index finger's,
/// for either hand.
Vec3f thumb_side(const std::array<Pose, kSegments>& pose) {
  const auto knuckle = [&](int digit) { return pose[static_cast<std::size_t>(segment_index(digit, 0))].p; };
  const Vec3 across = knuckle(1) - knuckle(kDigits - 1);
  return across.stableNormalized().cast<float>();
}

Contents collect(const DrawnHand& hand, const TriangleMesh& object, const Snapshot& snapshot,
                 double full_force) {
  Contents contents;
  double peak = 0.0;
  for (const SegmentSnapshot& segment : snapshot.segment) peak = std::max(peak, segment.force);
  contents.full_force = full_force > 0.0 ? full_force : peak > 0.0 ? rounded_up(peak) : 0.0;
  contents.thumb_side = thumb_side(snapshot.gdp_pose);
  SegmentColours colours;
  for (std::size_t s = 0; s < kSegments; ++s) {
    const auto part = static_cast<int>(s);
    const SegmentSnapshot& segment = snapshot.segment[s];
    const double share = contents.full_force > 0.0 ? segment.force / contents.full_force : 0.0;
    colours[s] = force_colour(static_cast<float>(share));
    if (!(segment.force > 0.0)) continue;
    append_arrow(contents.arrows, segment.point, segment.normal, kArrowAtFull * share, kShaft, part);
    append_ball(contents.arrows, segment.point, 1.9 * kShaft, part);
    contents.contacts.push_back({.point = segment.point.cast<float>(),
                                 .normal = segment.normal.cast<float>(),
                                 .weight = static_cast<float>(segment.force)});
  }
  append_hand(contents.solid, hand, snapshot.gdp_pose, colours);
  append_ghost(contents.ghost, hand, snapshot.gdp_pose, snapshot.hcp_pose);
  append_curved(contents.solid, object, {},
                {.level = kLevel,
                 .part = [](std::size_t) { return kObjectPart; },
                 .albedo = [](std::size_t, const Vec3&, const Vec3f&) { return kObjectAlbedo; }});
  return contents;
}

class Renderer {
 public:
  Renderer(Contents contents, const PictureOptions& options)
      : options_(options),
        device_(make_device()),
        full_force_(contents.full_force),
        solid_(device_.get(), std::move(contents.solid)),
        ghost_(device_.get(), std::move(contents.ghost)),
        arrows_(device_.get(), std::move(contents.arrows)),
        camera_(camera(contents, options)) {
    float low = 1e9F, high = -1e9F;
    for (const Vec3f& v : solid_.mesh().vertices) {
      low = std::min(low, v.z());
      high = std::max(high, v.z());
    }
    // The key light is left of the camera, above and a little behind it.
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
  [[nodiscard]] Camera camera(const Contents& contents, const PictureOptions& options) const {
    if (options.view)
      return camera_along(options.view->normalized().cast<float>(),
                          {&solid_.mesh(), &ghost_.mesh(), &arrows_.mesh()}, options.width, options.height);
    return choose_camera(solid_, {&ghost_.mesh(), &arrows_.mesh()}, contents.contacts, contents.thumb_side,
                         options.width, options.height);
  }

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
      const Material material{.albedo = hit->albedo, .gloss = hit->part == kObjectPart ? 1.0F : kHandGloss};
      colour = shade(solid_, studio_, point, *hit, ray.direction, material, sampler);
    } else {
      colour = background(y) * floor_share(ray, sampler);
    }
    if (const auto ghost = ghost_.closest(ray)) {
      const float edge = 1.0F - std::abs(ghost->normal.dot(ray.direction));
      float cover = 0.13F + 0.60F * edge * edge * edge;
      if (hit) {
        // If the two hands almost coincide, the ghost fades out; inside the object it stays faintly visible.
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

  [[nodiscard]] float floor_share(const Ray& ray, Sampler& sampler) const {
    if (ray.direction.z() > -1e-3F) return 1.0F;
    const float distance = (studio_.floor_z - ray.origin.z()) / ray.direction.z();
    if (distance <= 0.0F) return 1.0F;
    return floor_light(solid_, studio_, ray.origin + distance * ray.direction, sampler);
  }

  /// Applies exposure, a soft shoulder for the highlights, and sRGB.
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
  double full_force_;
  RayScene solid_, ghost_, arrows_;
  Camera camera_;
  Studio studio_;
  Canvas canvas_;
};

}  // namespace
}  // namespace picture

Image render_picture(const DrawnHand& hand, const TriangleMesh& object, const Snapshot& snapshot,
                     const PictureOptions& options) {
  if (std::min(options.width, options.height) < 16 || std::max(options.width, options.height) > 16384) {
    throw std::invalid_argument(fmt::format("picture of {} x {} pixels: each must be from 16 to 16384",
                                            options.width, options.height));
  }
  if (options.samples < 1 || options.samples > 32) {
    throw std::invalid_argument(
        fmt::format("picture with {} samples: must be from 1 to 32", options.samples));
  }
  if (options.view && !(options.view->head<2>().norm() > 1e-6 * options.view->norm()))
    throw std::invalid_argument("picture: the view must be finite, not zero and not vertical");
  return picture::Renderer(picture::collect(hand, object, snapshot, options.full_force), options).render();
}

}  // namespace phalanx
