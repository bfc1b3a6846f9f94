// SPDX-License-Identifier: Apache-2.0
// The searches themselves, compiled once for each instruction set.                          docs/contact.md
#pragma once

#include "contact/search/lens_box.h"
#include "contact/search/pack.h"
#include "contact/search/search_functions.h"
#include "contact/search/triangle_pair.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

PHALANX_INLINE double greater(double a, double b) noexcept { return a > b ? a : b; }
PHALANX_INLINE double dot3(const double* a, const double* b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
PHALANX_INLINE void cross3(const double* a, const double* b, double* out) noexcept {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/// How far the corners of a segment's triangle go within the horizon, to second order, and what the third
/// order may add [m]. Null: it does not move.
struct Sweep {
  const MotionView* motion;
  double horizon;
  double rest;  ///< jerk horizon^3 / 6
};

PHALANX_INLINE void velocity_at(const MotionView& motion, const double* x, double* v) noexcept {
  cross3(motion.angular, x, v);
  for (int i = 0; i < 3; ++i) v[i] += motion.linear[i];
}
PHALANX_INLINE void acceleration_at(const MotionView& motion, const double* x, const double* v,
                                    double* a) noexcept {
  double turn[3];
  double around[3];
  cross3(motion.angular_rate, x, turn);
  cross3(motion.angular, v, around);
  for (int i = 0; i < 3; ++i) a[i] = turn[i] + motion.linear_rate[i] + around[i];
}

/// Places a triangle of the segment, once a query.
PHALANX_INLINE const PlacedTriangle& placed_triangle(const SegmentView& segment, std::int32_t i,
                                                     const Sweep& sweep) noexcept {
  PlacedTriangle& t = segment.placed[i];
  if (t.query == segment.query) return t;
  t.query = segment.query;
  const SegmentTriangle& rest = segment.triangles[i];
  for (int c = 0; c < 3; ++c) {
    const double* r = rest.corner[c];
    for (int k = 0; k < 3; ++k) t.corner[c][k] = dot3(segment.R[k], r) + segment.p[k];
  }
  double u[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = t.corner[1][k] - t.corner[0][k];
    v[k] = t.corner[2][k] - t.corner[0][k];
  }
  cross3(u, v, t.normal);
  const double squared = dot3(t.normal, t.normal);
  const double scale = squared > 0.0 ? 1.0 / square_root(all(squared))[0] : 0.0;
  for (int k = 0; k < 3; ++k) t.normal[k] *= scale;
  t.above = t.below = 0.0;
  for (int c = 0; c < 3; ++c) {
    double first = 0.0;
    double second = 0.0;
    for (int k = 0; k < 3; ++k) t.first[c][k] = t.second[c][k] = 0.0;
    if (sweep.motion != nullptr) {
      double velocity[3];
      double acceleration[3];
      velocity_at(*sweep.motion, t.corner[c], velocity);
      acceleration_at(*sweep.motion, t.corner[c], velocity, acceleration);
      for (int k = 0; k < 3; ++k) {
        t.first[c][k] = velocity[k] * sweep.horizon;
        t.second[c][k] = 0.5 * acceleration[k] * sweep.horizon * sweep.horizon;
      }
      first = dot3(t.normal, t.first[c]);
      second = dot3(t.normal, t.second[c]);
    }
    double r[3];
    for (int k = 0; k < 3; ++k) r[k] = t.corner[c][k] - t.corner[0][k];
    const double height = dot3(t.normal, r);
    t.above = greater(t.above, height + greater(first, 0.0) + greater(second, 0.0) + sweep.rest);
    t.below = greater(t.below, -height + greater(-first, 0.0) + greater(-second, 0.0) + sweep.rest);
  }
  return t;
}

/// The triangles of a block from lane i on.
PHALANX_INLINE Triangles block_triangles(const TriangleBlock& block, int i) noexcept {
  Triangles t;
  for (int c = 0; c < 3; ++c)
    t.corner[c] = {load(block.corner[c][0] + i), load(block.corner[c][1] + i), load(block.corner[c][2] + i)};
  return t;
}

/// Lower bounds on the distance that a triangle of the segment keeps, all along its sweep, from triangles of
/// the object: what the plane of the one and the planes of the others separate.
PHALANX_INLINE Doubles separation(const PlacedTriangle& s, const Triangles& t, const Sweep& sweep) noexcept {
  const Vectors normal = all(s.normal);
  const Vectors origin = all(s.corner[0]);
  Doubles low = dot(normal, t.corner[0] - origin);
  Doubles high = low;
  for (int c = 1; c < 3; ++c) {
    const Doubles height = dot(normal, t.corner[c] - origin);
    low = least(low, height);
    high = most(high, height);
  }
  const Doubles own = most(low - s.above, -high - s.below);

  const Vectors u = t.corner[1] - t.corner[0];
  const Vectors v = t.corner[2] - t.corner[0];
  Vectors n = cross(u, v);
  const Doubles squared = dot(n, n);
  n = pick(squared > 0.0, 1.0 / square_root(squared), all(0.0)) * n;
  const Doubles top = most(positive(dot(n, u)), dot(n, v));
  const Doubles bottom = most(positive(-dot(n, u)), -dot(n, v));
  Doubles over = all(1e300);
  Doubles under = all(1e300);
  for (int c = 0; c < 3; ++c) {
    const Doubles height = dot(n, all(s.corner[c]) - t.corner[0]);
    const Doubles first = dot(n, all(s.first[c]));
    const Doubles second = dot(n, all(s.second[c]));
    over = least(over, height - positive(-first) - positive(-second));
    under = least(under, -height - positive(first) - positive(second));
  }
  return most(own, most(over - top, under - bottom) - sweep.rest);
}

/// Rounded towards the safe side for a comparison in single precision.
PHALANX_INLINE float single_cap(double cap) noexcept {
  return cap < 1e15 ? static_cast<float>(cap) * 1.000001F + 1e-12F : 1e15F;
}

/// One number of each of several pairs, side by side.
template <class At>
PHALANX_INLINE Doubles each(At&& at) noexcept {
#if PHALANX_DOUBLES == 8
  return Doubles{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
#elif PHALANX_DOUBLES == 4
  return Doubles{at(0), at(1), at(2), at(3)};
#else
  return Doubles{at(0), at(1)};
#endif
}

/// The object's triangles of several pairs.
PHALANX_INLINE Triangles object_triangles(const ObjectView& object, const PairIndex* pairs) noexcept {
  const double* from[kDoubles];
  for (int l = 0; l < kDoubles; ++l)
    from[l] = object.blocks[pairs[l].slot / kWide].corner[0][0] + pairs[l].slot % kWide;
  Triangles t;
  for (int c = 0; c < 3; ++c) {
    const auto axis = [&](int k) { return each([&](int l) { return from[l][(3 * c + k) * kWide]; }); };
    t.corner[c] = {axis(0), axis(1), axis(2)};
  }
  return t;
}

/// Pairs on their way to the exact distance: it is found for as many as there are lanes at once.
class Waiting {
 public:
  Waiting(const SegmentView& segment, const ObjectView& object) noexcept
      : segment_(segment), object_(object) {}

  /// The pair's segment triangle is placed. @returns whether as many wait as can be taken at once
  PHALANX_INLINE bool add(const PairIndex& pair) noexcept {
    pair_[count_++] = pair;
    return count_ == kDoubles;
  }
  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] const PairIndex& pair(int i) const noexcept { return pair_[i]; }

  /// The closest points of those that wait, in the order in which they came; then none waits.
  PHALANX_INLINE Closest take() noexcept {
    for (int l = count_; l < kDoubles; ++l) pair_[l] = pair_[count_ - 1];
    Triangles mine;
    for (int c = 0; c < 3; ++c) {
      const auto axis = [&](int k) {
        return each([&](int l) { return segment_.placed[pair_[l].triangle].corner[c][k]; });
      };
      mine.corner[c] = {axis(0), axis(1), axis(2)};
    }
    count_ = 0;
    return closest_points(mine, object_triangles(object_, pair_));
  }

 private:
  const SegmentView& segment_;
  const ObjectView& object_;
  PairIndex pair_[kDoubles];
  int count_ = 0;
};

inline void visit(const SegmentView& segment, const ObjectView& object, double cap_squared,
                  bool nearest_first, PairSink sink, void* context) noexcept {
  const Sweep still{nullptr, 0.0, 0.0};
  double cap = 0.0;
  float box_cap = 0.0F;
  const auto look_no_farther = [&] {
    cap = square_root(all(cap_squared))[0] * 1.000000001;
    box_cap = single_cap(cap);
  };
  look_no_farther();
  Waiting waiting(segment, object);
  const auto flush = [&] {
    const int count = waiting.count();
    if (count == 0) return;
    const Closest closest = waiting.take();
    for (int l = 0; l < count; ++l) {
      if (!(closest.squared[l] <= cap_squared)) continue;
      const PairDistance found{waiting.pair(l),
                               closest.squared[l],
                               {closest.on_a.x[l], closest.on_a.y[l], closest.on_a.z[l]},
                               {closest.on_b.x[l], closest.on_b.y[l], closest.on_b.z[l]}};
      sink(context, found, cap_squared);
    }
    look_no_farther();
  };
  const auto leaf = [&](std::int32_t triangle, std::int32_t block, float) {
    const PlacedTriangle& s = placed_triangle(segment, triangle, still);
    for (int i = 0; i < kWide; i += kDoubles) {
      const Doubles apart = separation(s, block_triangles(object.blocks[block], i), still);
      for (unsigned left = double_bits(apart <= cap); left != 0; left &= left - 1) {
        const std::int32_t slot = block * kWide + i + __builtin_ctz(left);
        if (slot >= object.size) break;
        if (waiting.add({triangle, slot})) flush();
      }
    }
  };
  Walk walk(segment, object);
  const auto wanted = [&](float bound) { return bound <= box_cap; };
  if (nearest_first) {
    walk.run<true>(box_cap, wanted, leaf);
  } else {
    walk.run<false>(box_cap, wanted, leaf);
  }
  flush();
}

/// Nearest first, and what is not nearer than kEnough of the best so far is believed and not looked into;
/// after kMostExact pairs nothing is: a bound need not be tight, but it must come soon.
inline double lower_bound(const SegmentView& segment, const ObjectView& object, double cap) noexcept {
  constexpr double kEnough = 0.8;
  constexpr int kMostExact = 256;
  const Sweep still{nullptr, 0.0, 0.0};
  double best = cap;
  double believed = cap;
  float box_cap = single_cap(cap);
  int looked_into = 0;
  const auto is_enough = [&](double bound) {
    if (bound < kEnough * best && looked_into < kMostExact) return false;
    believed = bound < believed ? bound : believed;
    return true;
  };
  Waiting waiting(segment, object);
  const auto flush = [&] {
    const int count = waiting.count();
    if (count == 0) return;
    looked_into += count;
    const Doubles exact = square_root(waiting.take().squared);
    for (int l = 0; l < count; ++l) best = exact[l] < best ? exact[l] : best;
    box_cap = single_cap(best);
  };
  Walk walk(segment, object);
  walk.run<true>(
      box_cap, [&](float bound) { return !is_enough(static_cast<double>(bound)); },
      [&](std::int32_t triangle, std::int32_t block, float bound) {
        const PlacedTriangle& s = placed_triangle(segment, triangle, still);
        for (int i = 0; i < kWide; i += kDoubles) {
          const Doubles apart = most(separation(s, block_triangles(object.blocks[block], i), still),
                                     all(static_cast<double>(bound)));
          for (int l = 0; l < kDoubles && block * kWide + i + l < object.size; ++l) {
            if (is_enough(apart[l])) continue;
            if (waiting.add({triangle, block * kWide + i + l})) flush();
          }
        }
      });
  flush();
  const double found = best < believed ? best : believed;
  return found < cap ? greater(found * 0.999999999, 0.0) : cap;
}

inline void gather(const SegmentView& segment, const ObjectView& object, const MotionView& motion,
                   double speed, double margin, PairStore& store) noexcept {
  const double keep = margin * 1.000000001 + 1e-15;
  double horizon = 0.0;
  Sweep sweep{&motion, 0.0, 0.0};
  float box_cap = 0.0F;
  const auto look_ahead = [&] {
    horizon = store.horizon;
    sweep.horizon = horizon;
    sweep.rest = motion.jerk * horizon * horizon * horizon / 6.0;
    box_cap = single_cap(margin + speed * horizon);
  };
  look_ahead();
  Walk walk(segment, object);
  walk.run<true>(
      box_cap, [&](float bound) { return bound <= box_cap; },
      [&](std::int32_t triangle, std::int32_t block, float) {
        const PlacedTriangle& s = placed_triangle(segment, triangle, sweep);
        for (int i = 0; i < kWide; i += kDoubles) {
          const Doubles apart = separation(s, block_triangles(object.blocks[block], i), sweep);
          for (unsigned left = ~double_bits(apart > keep) & ((1U << kDoubles) - 1); left != 0;
               left &= left - 1) {
            const std::int32_t slot = block * kWide + i + __builtin_ctz(left);
            if (slot >= object.size) break;
            if (store.count == store.capacity) {
              store.make_room(store.context);
              if (store.horizon < horizon) look_ahead();
            }
            store.pair[store.count++] = {triangle, slot};
          }
        }
      });
}

/// The largest h up to which  gap - v h + a h^2 / 2 - jerk h^3 / 6  stays positive, or somewhat less: with
/// h <= limit the cubic term is at most jerk limit h^2 / 6.
PHALANX_INLINE Doubles quadratic_step(const Doubles& gap, const Doubles& v, const Doubles& a, double jerk,
                                      const Doubles& limit) noexcept {
  const Doubles A = jerk / 3.0 * limit - a;  // deceleration counts against the gap
  const Doubles inside = v * v + 2.0 * A * gap;
  const Doubles root = square_root(positive(inside));
  const Doubles closing = 2.0 * gap / (v + root);  // v > 0
  const Doubles opening = (root - v) / A;          // v <= 0, A > 0
  const Doubles never = all(1e300);
  Doubles h = pick(v > 0.0, pick(inside >= 0.0, closing, never), pick(A > 0.0, opening, never));
  return least(h, limit);
}

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
    // Already within the margin: only motion that closes it is stopped. Less than a nanometre a tick is no
    // motion, as long as there is room for it above the floor.
    const Doubles creep = pick(distance > floor, all(1e-9), all(0.0));
    const Doubles closing = -dot(normal, velocity(closest.on_a));
    const DoubleMask blocked = (within & (closing > creep)) | ~apart;
    const Doubles lowest = pick(within, least(all(floor), distance - 5e-10), all(floor));
    Doubles step = all(horizon);
    Doubles end = all(1e300);
    for (int c = 0; c < 3; ++c) {
      const Vectors v = velocity(a.corner[c]);
      const Vectors acceleration = cross(angular_rate, a.corner[c]) + linear_rate + cross(angular, v);
      const Doubles height = dot(normal, a.corner[c] - closest.on_b);
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

inline void closest(const double (*a)[3], const double (*b)[3], PairDistance& out) noexcept {
  Triangles ta;
  Triangles tb;
  for (int c = 0; c < 3; ++c) {
    ta.corner[c] = {all(a[c][0]), all(a[c][1]), all(a[c][2])};
    tb.corner[c] = {all(b[c][0]), all(b[c][1]), all(b[c][2])};
  }
  const Closest found = closest_points(ta, tb);
  out = {{0, 0},
         found.squared[0],
         {found.on_a.x[0], found.on_a.y[0], found.on_a.z[0]},
         {found.on_b.x[0], found.on_b.y[0], found.on_b.z[0]}};
}

inline constexpr SearchFunctions kFunctions{&visit, &lower_bound, &gather, &advance, &closest};

}  // namespace phalanx::search::PHALANX_SEARCH_SET
