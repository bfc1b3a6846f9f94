// SPDX-License-Identifier: Apache-2.0
// Pairs of features (edges, corners and faces) of two triangles; the closest points are those of
// one such pair.
#pragma once

#include <array>

#include "phalanx/contact/triangle_distance.h"

namespace phalanx {

inline double clamp01(double x) noexcept { return x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x); }

/// Hands the closest points of the segments p + s u and q + t v, s and t in [0, 1], to keep(on_a, on_b).
/// Either segment may be a point.
template <class Keep>
void edge_edge(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v, Keep&& keep) noexcept {
  const Vec3 r = p - q;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double ur = u.dot(r);
  const double vr = v.dot(r);
  // This is |u x v|^2. For nearly parallel segments any s serves: the projections below optimise it.
  const double denominator = uu * vv - uv * uv;
  double s = denominator > 1e-14 * uu * vv ? clamp01((uv * vr - vv * ur) / denominator) : 0.0;
  double t = vv > 0.0 ? clamp01((uv * s + vr) / vv) : 0.0;
  s = uu > 0.0 ? clamp01((uv * t - ur) / uu) : 0.0;
  keep(p + s * u, q + t * v);
}

/// Plane of a triangle, unnormalised.
struct Face {
  Vec3 corner;
  Vec3 normal;
  double normal_squared;
  std::array<Vec3, 3> inward;  ///< in the plane, normal to each edge, towards the inside
};

inline Face face_of(const Corners& t) noexcept {
  Face face;
  face.corner = t[0];
  face.normal = (t[1] - t[0]).cross(t[2] - t[0]);
  face.normal_squared = face.normal.squaredNorm();
  // A sliver's normal is rounding noise. Its edges, which are as near to within its width, suffice.
  const double edges_squared = (t[1] - t[0]).squaredNorm() * (t[2] - t[0]).squaredNorm();
  if (!(face.normal_squared > 1e-18 * edges_squared)) face.normal_squared = 0.0;
  for (std::size_t i = 0; i < 3; ++i) face.inward[i] = face.normal.cross(t[(i + 1) % 3] - t[i]);
  return face;
}

inline bool projects_inside(const Corners& t, const Face& face, const Vec3& p) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    if (face.inward[i].dot(p - t[i]) < 0.0) return false;
  }
  return true;
}

/// Hands the corner-face pairs of `points` against `t` to keep(corner, foot).
template <class Keep>
void corners_against_face(const Corners& points, const Corners& t, const Face& face, Keep&& keep) noexcept {
  if (!(face.normal_squared > 0.0)) return;  // a segment or a point: its edges suffice
  for (const Vec3& point : points) {
    const double height = face.normal.dot(point - face.corner);  // times |normal|
    if (projects_inside(t, face, point)) keep(point, point - (height / face.normal_squared) * face.normal);
  }
}

/// Hands the closest points of every pair of features to keep(on_a, on_b), in a fixed order.
/// @pre the triangles do not cross
template <class Keep>
void for_each_feature_pair(const Corners& a, const Corners& b, Keep&& keep) noexcept {
  const std::array<Vec3, 3> ea = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Vec3, 3> eb = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) edge_edge(a[i], ea[i], b[j], eb[j], keep);
  }
  corners_against_face(a, b, face_of(b), keep);
  corners_against_face(b, a, face_of(a), [&](const Vec3& corner, const Vec3& foot) { keep(foot, corner); });
}

/// Returns the point of the segment p + s u, s in [0, 1], that is nearest to x.
inline Vec3 nearest_on_edge(const Vec3& p, const Vec3& u, const Vec3& x) noexcept {
  const double uu = u.squaredNorm();
  return uu > 0.0 ? Vec3(p + clamp01(u.dot(x - p) / uu) * u) : p;
}

}  // namespace phalanx
