// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/picture/letters.h"

namespace phalanx::picture {
namespace {

using Vec2f = Eigen::Vector2f;
const Vec3f kInk(0.035F, 0.04F, 0.055F);

}  // namespace

Vec3f force_colour(float share) {
  static const std::array<Vec3f, 4> kStops = {Vec3f(0.80F, 0.66F, 0.54F), Vec3f(0.95F, 0.55F, 0.16F),
                                              Vec3f(0.86F, 0.20F, 0.05F), Vec3f(0.50F, 0.02F, 0.05F)};
  const float x = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), kStops.size() - 2);
  const float t = x - static_cast<float>(i);
  return (1.0F - t) * kStops[i] + t * kStops[i + 1];
}

void draw_stroke(Canvas& canvas, const Vec2f& a, const Vec2f& b, float width, const Vec3f& colour) {
  const float reach = 0.5F * width + 1.0F;
  const auto bound = [](float v, int limit) { return std::clamp(static_cast<int>(v), 0, limit); };
  const int x0 = bound(std::floor(std::min(a.x(), b.x()) - reach), canvas.width);
  const int x1 = bound(std::ceil(std::max(a.x(), b.x()) + reach), canvas.width);
  const int y0 = bound(std::floor(std::min(a.y(), b.y()) - reach), canvas.height);
  const int y1 = bound(std::ceil(std::max(a.y(), b.y()) + reach), canvas.height);
  const Vec2f ab = b - a;
  const float length2 = std::max(ab.squaredNorm(), 1e-12F);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const Vec2f p(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      const float t = std::clamp((p - a).dot(ab) / length2, 0.0F, 1.0F);
      const float cover = std::clamp(0.5F * width + 0.5F - (p - a - t * ab).norm(), 0.0F, 1.0F);
      if (cover <= 0.0F) continue;
      Vec3f& pixel = canvas.pixel[static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width) +
                                  static_cast<std::size_t>(x)];
      pixel += cover * (colour - pixel);
    }
  }
}

float draw_text(Canvas& canvas, float x, float y, float size, std::string_view text, const Vec3f& colour) {
  const float unit = size / 6.0F;
  float pen = x;
  for (const char c : text) {
    Strokes lines;
    letter_strokes(c, lines);
    for (const auto& [a, b] : lines) {
      draw_stroke(canvas, {pen + unit * a.x(), y - unit * a.y()}, {pen + unit * b.x(), y - unit * b.y()},
                  0.13F * size, colour);
    }
    pen += unit * letter_advance(c);
  }
  return pen - x;
}

void draw_force_scale(Canvas& canvas, double full_force) {
  const float s = static_cast<float>(canvas.height) / 960.0F;
  const float left = 44.0F * s, width = 18.0F * s, height = 240.0F * s;
  const float bottom = static_cast<float>(canvas.height) - 56.0F * s;
  const auto rows = static_cast<int>(height);
  for (int row = 0; row < rows; ++row) {
    const float share = (static_cast<float>(row) + 0.5F) / static_cast<float>(rows);
    const float y = bottom - share * height;
    draw_stroke(canvas, {left, y}, {left + width, y}, 1.2F, force_colour(share));
  }
  for (int i = 0; i <= 4; ++i) {
    const float y = bottom - height * static_cast<float>(i) / 4.0F;
    draw_stroke(canvas, {left + width + 3.0F * s, y}, {left + width + 8.0F * s, y}, 1.6F * s, kInk);
    if (i % 2 == 0) {
      draw_text(canvas, left + width + 15.0F * s, y + 7.0F * s, 14.0F * s,
                fmt::format("{:.3g} N", full_force * i / 4.0), kInk);
    }
  }
}

}  // namespace phalanx::picture
