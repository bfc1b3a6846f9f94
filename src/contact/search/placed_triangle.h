// SPDX-License-Identifier: Apache-2.0
// A segment's triangles at the pose of a query, their displacement, and their separation from the object's.
#pragma once

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

/// Displacement of the corners of a segment's triangle within the horizon to second order, and a bound on the
/// third [m]. A null motion means at rest.
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
  for (double& n : t.normal) n *= scale;
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

/// Returns the triangles of a block from lane i on.
PHALANX_INLINE Triangles block_triangles(const TriangleBlock& block, int i) noexcept {
  Triangles t;
  for (int c = 0; c < 3; ++c)
    t.corner[c] = {load(block.corner[c][0] + i), load(block.corner[c][1] + i), load(block.corner[c][2] + i)};
  return t;
}

/// Returns lower bounds on the distance of a triangle of the segment from triangles of the object, all along
/// its sweep. It uses the separation by either triangle's plane.
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

}  // namespace phalanx::search::PHALANX_SEARCH_SET
