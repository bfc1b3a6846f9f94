// SPDX-License-Identifier: Apache-2.0
// Exact distance of triangles, one pair a lane, as triangle_distance.h defines it.
#pragma once

#include "contact/search/pack.h"

namespace phalanx::search::PHALANX_SEARCH_SET {

/// Triangles, one a lane.
struct Triangles {
  Vectors corner[3];
};

/// Nearest features found so far.
struct Closest {
  Doubles squared;
  Vectors on_a;
  Vectors on_b;

  PHALANX_INLINE void offer(const DoubleMask& valid, const Vectors& a, const Vectors& b) noexcept {
    const Vectors d = a - b;
    const Doubles s = dot(d, d);
    const DoubleMask better = valid & (s < squared);
    squared = pick(better, s, squared);
    on_a = pick(better, a, on_a);
    on_b = pick(better, b, on_b);
  }
};

struct Edge {
  Vectors from;
  Vectors along;
  Doubles squared;
  Doubles inverse;  ///< 1 / squared; 0 for a point
};

PHALANX_INLINE void edges_of(const Triangles& t, Edge (&edge)[3]) noexcept {
  for (int i = 0; i < 3; ++i) {
    edge[i].from = t.corner[i];
    edge[i].along = t.corner[(i + 1) % 3] - t.corner[i];
    edge[i].squared = dot(edge[i].along, edge[i].along);
    edge[i].inverse = pick(edge[i].squared > 0.0, 1.0 / edge[i].squared, all(0.0));
  }
}

/// Offers the closest points of two edges, either of which may be a point. For nearly parallel edges any s
/// serves: the projections optimise it.
PHALANX_INLINE void edge_edge(const Edge& a, const Edge& b, Closest& closest) noexcept {
  const Vectors r = a.from - b.from;
  const Doubles ab = dot(a.along, b.along);
  const Doubles ar = dot(a.along, r);
  const Doubles br = dot(b.along, r);
  const Doubles both = a.squared * b.squared;
  const Doubles sine = both - ab * ab;  // |a x b|^2
  const DoubleMask skew = sine > 1e-14 * both;
  Doubles s = pick(skew, clamp01((ab * br - b.squared * ar) / pick(skew, sine, all(1.0))), all(0.0));
  const Doubles t = clamp01((ab * s + br) * b.inverse);
  s = clamp01((ab * t - ar) * a.inverse);
  const Vectors on_a = a.from + s * a.along;
  const Vectors on_b = b.from + t * b.along;
  closest.offer(on_a.x == on_a.x, on_a, on_b);
}

/// Offers the corners of `points` against the face of `t`, and tests whether an edge of `points` pierces it.
/// @returns the lanes where one does, with the point in `pierced`
PHALANX_INLINE DoubleMask corners_against_face(const Triangles& points, const Edge (&points_edge)[3],
                                               const Triangles& t, const Edge (&edge)[3], bool points_are_a,
                                               Closest& closest, Vectors& pierced) noexcept {
  const Vectors normal = cross(edge[0].along, t.corner[2] - t.corner[0]);
  const Doubles squared = dot(normal, normal);
  // A sliver's normal is rounding noise. Its edges, which are as near to within its width, suffice.
  const DoubleMask plane = squared > 1e-18 * (edge[0].squared * edge[2].squared);
  const Doubles inverse = 1.0 / pick(plane, squared, all(1.0));
  const Vectors inward[3] = {cross(normal, edge[0].along), cross(normal, edge[1].along),
                             cross(normal, edge[2].along)};
  const auto inside = [&](const Vectors& p) {
    return (dot(inward[0], p - t.corner[0]) >= 0.0) & (dot(inward[1], p - t.corner[1]) >= 0.0) &
           (dot(inward[2], p - t.corner[2]) >= 0.0);
  };
  Doubles height[3];
  for (int i = 0; i < 3; ++i) {
    height[i] = dot(normal, points.corner[i] - t.corner[0]);
    const Vectors foot = points.corner[i] - (height[i] * inverse) * normal;
    const DoubleMask valid = plane & inside(points.corner[i]);
    if (points_are_a) {
      closest.offer(valid, points.corner[i], foot);
    } else {
      closest.offer(valid, foot, points.corner[i]);
    }
  }
  DoubleMask hit = squared < 0.0;  // none
  for (int i = 0; i < 3; ++i) {
    const Doubles from = height[i];
    const Doubles to = height[(i + 1) % 3];
    const DoubleMask crosses = plane & (((from > 0.0) & (to < 0.0)) | ((from < 0.0) & (to > 0.0)));
    if (double_bits(crosses) == 0) continue;
    const Doubles share = from / pick(crosses, from - to, all(1.0));
    const Vectors at = points.corner[i] + share * points_edge[i].along;
    const DoubleMask through = crosses & inside(at);
    pierced = pick(through & ~hit, at, pierced);
    hit = hit | through;
  }
  return hit;
}

/// Returns the closest points of a and b: the least over 9 pairs of edges and 6 of corner and face, or
/// a common point.
PHALANX_INLINE Closest closest_points(const Triangles& a, const Triangles& b) noexcept {
  Edge ea[3];
  Edge eb[3];
  edges_of(a, ea);
  edges_of(b, eb);
  const Vectors first = a.corner[0] - b.corner[0];
  Closest closest{dot(first, first), a.corner[0], b.corner[0]};
  for (const Edge& of_a : ea) {
    for (const Edge& of_b : eb) edge_edge(of_a, of_b, closest);
  }
  Vectors pierced = a.corner[0];
  DoubleMask hit = corners_against_face(a, ea, b, eb, true, closest, pierced);
  hit = hit | corners_against_face(b, eb, a, ea, false, closest, pierced);
  closest.squared = pick(hit, all(0.0), closest.squared);
  closest.on_a = pick(hit, pierced, closest.on_a);
  closest.on_b = pick(hit, pierced, closest.on_b);
  return closest;
}

}  // namespace phalanx::search::PHALANX_SEARCH_SET
