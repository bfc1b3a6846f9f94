// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles of a moving segment: those that may meet, and how far each may advance.
#pragma once

#include "contact/search/lens_box.h"
#include "contact/search/near_pairs.h"
#include "contact/search/placed_triangle.h"
#include "contact/search/search_functions.h"
#include "contact/search/triangle_pair.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// Returns the lenses' motion within the horizon. All its bounds grow with the horizon, so that lenses placed
/// for a longer one stay safe.
PHALANX_INLINE LensMotion lens_motion(const SegmentView& segment, const MotionView& motion,
                                      double horizon) noexcept {
  double at_centre[3];
  velocity_at(motion, segment.object_centre, at_centre);
  LensMotion lens;
  for (int k = 0; k < 3; ++k) {
    lens.angular[k] = static_cast<float>(motion.angular[k] * horizon);
    lens.linear[k] = static_cast<float>(at_centre[k] * horizon);
  }
  const double turning = square_root(all(dot3(motion.angular, motion.angular)))[0];
  // Single precision rounds the displacement of a point by less than a millionth of it.
  lens.spin = static_cast<float>(turning * horizon * 1.000001);
  lens.bend = static_cast<float>((0.5 * motion.bend * horizon + 2e-6 * motion.speed) * horizon * 1.000001);
  lens.reach = static_cast<float>(motion.speed * horizon * 1.000001);
  return lens;
}

/// Implements SearchFunctions::gather.
inline void gather(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                   double margin, PairStore& store) noexcept {
  const double keep = margin * 1.000000001 + 1e-15;
  const float box_cap = single_cap(margin);
  double horizon = 0.0;
  Sweep sweep{&motion, 0.0, 0.0};
  LensMotion lenses;
  const auto look_ahead = [&] {
    horizon = store.horizon;
    sweep.horizon = horizon;
    sweep.rest = motion.jerk * horizon * horizon * horizon / 6.0;
    lenses = lens_motion(segment, motion, horizon);
  };
  look_ahead();
  Walk<true> walk(segment, object, lenses);
  walk.run<true>(
      box_cap, [](float) { return true; },
      [&](std::int32_t triangle, std::int32_t block, float) {
        // There is room for the whole block, so that the horizon does not change between its lanes.
        if (store.capacity - store.count < kWide) {
          store.make_room(store.context);
          if (store.horizon < horizon) look_ahead();
        }
        const PlacedTriangle& s = placed_triangle(segment, triangle, sweep);
        for (int i = 0; i < kWide; i += kDoubles) {
          const Doubles apart = separation(s, block_triangles(object.blocks[block], i), sweep);
          for (unsigned left = ~double_bits(apart > keep) & ((1U << kDoubles) - 1); left != 0;
               left &= left - 1) {
            const std::int32_t slot = block * kWide + i + __builtin_ctz(left);
            if (slot >= object.size) break;
            store.pair[store.count++] = {triangle, slot};
          }
        }
      });
}

/// Returns the largest h, or somewhat less, up to which  gap - v h + a h^2 / 2 - jerk h^3 / 6  stays
/// positive. For h <= limit the cubic term is at most jerk limit h^2 / 6.
PHALANX_INLINE Doubles quadratic_step(const Doubles& gap, const Doubles& v, const Doubles& a, double jerk,
                                      const Doubles& limit) noexcept {
  const Doubles A = jerk / 3.0 * limit - a;  // deceleration reduces the gap
  const Doubles inside = v * v + 2.0 * A * gap;
  const Doubles root = square_root(positive(inside));
  const Doubles closing = 2.0 * gap / (v + root);  // v > 0
  const Doubles opening = (root - v) / A;          // v <= 0, A > 0
  const Doubles never = all(1e300);
  Doubles h = pick(v > 0.0, pick(inside >= 0.0, closing, never), pick(A > 0.0, opening, never));
  return least(h, limit);
}

/// Rigid motion of a segment from its pose on, the same in every lane.
struct Moving {
  Moving(const SegmentView& segment, const MotionView& motion) noexcept
      : R{all(segment.R[0]), all(segment.R[1]), all(segment.R[2])},
        p(all(segment.p)),
        angular(all(motion.angular)),
        linear(all(motion.linear)),
        angular_rate(all(motion.angular_rate)),
        linear_rate(all(motion.linear_rate)) {}

  /// Returns the segment's triangles of several pairs, at its pose.
  PHALANX_INLINE Triangles place(const SegmentTriangle* triangles, const PairIndex* pairs) const noexcept {
    Triangles t;
    for (int c = 0; c < 3; ++c) {
      const auto axis = [&](int k) {
        return each([&](int l) { return triangles[pairs[l].triangle].corner[c][k]; });
      };
      const Vectors x = {axis(0), axis(1), axis(2)};
      t.corner[c] = Vectors{dot(R[0], x), dot(R[1], x), dot(R[2], x)} + p;
    }
    return t;
  }
  PHALANX_INLINE Vectors velocity(const Vectors& x) const noexcept { return cross(angular, x) + linear; }
  /// @param v  the velocity at x
  PHALANX_INLINE Vectors acceleration(const Vectors& x, const Vectors& v) const noexcept {
    return cross(angular_rate, x) + linear_rate + cross(angular, v);
  }

  Vectors R[3];
  Vectors p;
  Vectors angular;
  Vectors linear;
  Vectors angular_rate;
  Vectors linear_rate;
};

/// Implements SearchFunctions::advance.
inline void advance(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                    double horizon, double margin, double floor, const PairIndex* pairs, int n,
                    PairStep* out) noexcept {
  const Moving moving(segment, motion);
  const double rest = motion.jerk * horizon * horizon * horizon / 6.0;
  for (int first = 0; first < n; first += kDoubles) {
    PairIndex batch[kDoubles];
    for (int l = 0; l < kDoubles; ++l) batch[l] = pairs[first + l < n ? first + l : n - 1];
    const Triangles a = moving.place(segment.triangles, batch);
    const Triangles b = object_triangles(object, batch);
    const Closest closest = closest_points(a, b);
    const Doubles distance = square_root(closest.squared);
    const DoubleMask apart = distance > 0.0;
    const Vectors normal = pick(apart, 1.0 / distance, all(0.0)) * (closest.on_a - closest.on_b);
    const DoubleMask within = distance <= margin;
    // Within the margin only closing motion is stopped. Closing by less than a nanometre a tick counts as
    // rest, as long as the pair is above the floor.
    const Doubles creep = pick(distance > floor, all(1e-9), all(0.0));
    const Doubles closing = -dot(normal, moving.velocity(closest.on_a));
    const DoubleMask blocked = (within & (closing > creep)) | ~apart;
    const Doubles lowest = pick(within, least(all(floor), distance - 5e-10), all(floor));
    Doubles step = all(horizon);
    Doubles end = all(1e300);
    for (const Vectors& x : a.corner) {
      const Vectors v = moving.velocity(x);
      const Doubles height = dot(normal, x - closest.on_b);
      const Doubles gap = positive(height - lowest);
      const Doubles speed = -dot(normal, v);
      const Doubles away = dot(normal, moving.acceleration(x, v));
      const Doubles coarse = quadratic_step(gap, speed, away, motion.jerk, all(horizon));
      const Doubles guess = square_root(coarse * horizon);
      const Doubles fine = quadratic_step(gap, speed, away, motion.jerk, guess);
      step = least(step, most(coarse, fine));
      end = least(end, height - positive(speed) * horizon - positive(-away) * (0.5 * horizon * horizon));
    }
    const DoubleMask near = within | (end - rest <= margin);
    const unsigned blocked_bits = double_bits(blocked);
    const unsigned near_bits = double_bits(near);
    for (int l = 0; l < kDoubles && first + l < n; ++l) {
      const bool stop = (blocked_bits >> l & 1U) != 0;
      out[first + l] = {stop ? 0.0 : step[l], stop, stop || (near_bits >> l & 1U) != 0};
    }
  }
}

/// Returns unit normals, or zero for triangles without an area.
PHALANX_INLINE Vectors unit_normals(const Triangles& t) noexcept {
  const Vectors n = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
  const Doubles squared = dot(n, n);
  return pick(squared > 0.0, 1.0 / square_root(squared), all(0.0)) * n;
}

/// Implements SearchFunctions::sift. It does for given pairs what separation() does for a block.
inline int sift(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                double horizon, double margin, PairIndex* pairs, int n) noexcept {
  const Moving moving(segment, motion);
  const double keep = margin * 1.000000001 + 1e-15;
  const double rest = motion.jerk * horizon * horizon * horizon / 6.0;
  const double half = 0.5 * horizon * horizon;
  int kept = 0;
  for (int first = 0; first < n; first += kDoubles) {
    PairIndex batch[kDoubles];
    for (int l = 0; l < kDoubles; ++l) batch[l] = pairs[first + l < n ? first + l : n - 1];
    const Triangles a = moving.place(segment.triangles, batch);
    const Triangles b = object_triangles(object, batch);
    const Vectors normals[2] = {unit_normals(a), unit_normals(b)};
    Doubles apart = all(-1e300);
    for (const Vectors& normal : normals) {
      Doubles low = all(1e300);  // heights of the segment's triangle along the motion
      Doubles high = all(-1e300);
      Doubles bottom = all(1e300);  // of the object's
      Doubles top = all(-1e300);
      for (int c = 0; c < 3; ++c) {
        const Vectors v = moving.velocity(a.corner[c]);
        const Doubles once = horizon * dot(normal, v);
        const Doubles twice = half * dot(normal, moving.acceleration(a.corner[c], v));
        const Doubles height = dot(normal, a.corner[c] - b.corner[0]);
        low = least(low, height - positive(-once) - positive(-twice));
        high = most(high, height + positive(once) + positive(twice));
        const Doubles other = dot(normal, b.corner[c] - b.corner[0]);
        bottom = least(bottom, other);
        top = most(top, other);
      }
      apart = most(apart, most(low - top, bottom - high));
    }
    const unsigned near = ~double_bits(apart - rest > keep);
    for (int l = 0; l < kDoubles && first + l < n; ++l)
      if ((near >> l & 1U) != 0) pairs[kept++] = batch[l];
  }
  return kept;
}

}  // namespace phalanx::search::PHALANX_SEARCH_SET
