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

/// Implements SearchFunctions::advance.
inline void advance(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                    double horizon, double margin, double floor, const PairIndex* pairs, int n,
                    PairStep* out) noexcept {
  const Vectors R[3] = {all(segment.R[0]), all(segment.R[1]), all(segment.R[2])};
  const Vectors p = all(segment.p);
  const Vectors angular = all(motion.angular);
  const Vectors linear = all(motion.linear);
  const Vectors angular_rate = all(motion.angular_rate);
  const Vectors linear_rate = all(motion.linear_rate);
  const double rest = motion.jerk * horizon * horizon * horizon / 6.0;
  for (int first = 0; first < n; first += kDoubles) {
    PairIndex batch[kDoubles];
    for (int l = 0; l < kDoubles; ++l) batch[l] = pairs[first + l < n ? first + l : n - 1];
    Triangles a;
    for (int c = 0; c < 3; ++c) {
      const auto axis = [&](int k) {
        return each([&](int l) { return segment.triangles[batch[l].triangle].corner[c][k]; });
      };
      const Vectors x = {axis(0), axis(1), axis(2)};
      a.corner[c] = Vectors{dot(R[0], x), dot(R[1], x), dot(R[2], x)} + p;
    }
    const Triangles b = object_triangles(object, batch);
    const Closest closest = closest_points(a, b);
    const Doubles distance = square_root(closest.squared);
    const DoubleMask apart = distance > 0.0;
    const Vectors normal = pick(apart, 1.0 / distance, all(0.0)) * (closest.on_a - closest.on_b);
    const auto velocity = [&](const Vectors& x) { return cross(angular, x) + linear; };
    const DoubleMask within = distance <= margin;
    // Within the margin only closing motion is stopped. Closing by less than a nanometre a tick counts as
    // rest, as long as the pair is above the floor.
    const Doubles creep = pick(distance > floor, all(1e-9), all(0.0));
    const Doubles closing = -dot(normal, velocity(closest.on_a));
    const DoubleMask blocked = (within & (closing > creep)) | ~apart;
    const Doubles lowest = pick(within, least(all(floor), distance - 5e-10), all(floor));
    Doubles step = all(horizon);
    Doubles end = all(1e300);
    for (const Vectors& x : a.corner) {
      const Vectors v = velocity(x);
      const Vectors acceleration = cross(angular_rate, x) + linear_rate + cross(angular, v);
      const Doubles height = dot(normal, x - closest.on_b);
      const Doubles gap = positive(height - lowest);
      const Doubles speed = -dot(normal, v);
      const Doubles away = dot(normal, acceleration);
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

}  // namespace phalanx::search::PHALANX_SEARCH_SET
