// SPDX-License-Identifier: Apache-2.0
// A second, plain distance of triangles, in double precision and without any tree: what the program is held
// against.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"
#include "support/reference/raw_file.h"
#include "support/reference/surface_bound.h"

namespace phalanx::test {

inline std::vector<RawTriangle> raw_of(const TriangleMesh& mesh, const Pose& X = {}) {
  std::vector<RawTriangle> out;
  for (const Triangle& t : mesh.triangles) {
    out.push_back({X * mesh.vertices[static_cast<std::size_t>(t[0])],
                   X * mesh.vertices[static_cast<std::size_t>(t[1])],
                   X * mesh.vertices[static_cast<std::size_t>(t[2])]});
  }
  return out;
}

/// As an importer's `size` does: the largest extent becomes `size`, the centre of the bounding box the
/// origin.
inline void scale_raw(std::vector<RawTriangle>& triangles, double size) {
  Vec3 least = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 most = -least;
  for (const RawTriangle& t : triangles) {
    for (const Vec3& v : t) {
      least = least.cwiseMin(v);
      most = most.cwiseMax(v);
    }
  }
  const double factor = size / (most - least).maxCoeff();
  for (RawTriangle& t : triangles) {
    for (Vec3& v : t) v = factor * (v - 0.5 * (least + most));
  }
}

/// Where the segment from p to q goes through the triangle, if it does.
inline bool pierces(const Vec3& p, const Vec3& q, const RawTriangle& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const double from = volume(t[0], t[1], t[2], p);
  const double to = volume(t[0], t[1], t[2], q);
  if (!((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0))) return false;
  const double a = volume(p, q, t[0], t[1]);
  const double b = volume(p, q, t[1], t[2]);
  const double c = volume(p, q, t[2], t[0]);
  return (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
}

/// Least distance of two straight segments: of the 4 ends from the other segment, and of the inner points of
/// both if those face each other.
inline double segment_distance(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  double best = std::min(
      std::min((nearest_on_triangle(p, r, s, s) - p).norm(), (nearest_on_triangle(q, r, s, s) - q).norm()),
      std::min((nearest_on_triangle(r, p, q, q) - r).norm(), (nearest_on_triangle(s, p, q, q) - s).norm()));
  const Vec3 n = (q - p).cross(s - r);
  const double nn = n.squaredNorm();
  if (nn > 1e-24 * (q - p).squaredNorm() * (s - r).squaredNorm() && nn > 0.0) {
    const double t = (r - p).cross(s - r).dot(n) / nn;
    const double u = (r - p).cross(q - p).dot(n) / nn;
    if (t > 0.0 && t < 1.0 && u > 0.0 && u < 1.0)
      best = std::min(best, std::abs(n.dot(r - p)) / std::sqrt(nn));
  }
  return best;
}

inline double triangle_gap(const RawTriangle& a, const RawTriangle& b) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return 0.0;
    best = std::min(best, (nearest_on_triangle(a[i], b[0], b[1], b[2]) - a[i]).norm());
    best = std::min(best, (nearest_on_triangle(b[i], a[0], a[1], a[2]) - b[i]).norm());
    for (std::size_t j = 0; j < 3; ++j)
      best = std::min(best, segment_distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return best;
}

/// Least distance of any triangle of `a` from any of `b`, all pairs, if below `cap` [m]; 0 where they cross.
inline double brute_force_gap(const std::vector<RawTriangle>& a, const std::vector<RawTriangle>& b,
                              double cap) {
  struct Ball {
    Vec3 centre;
    double radius;
  };
  const auto balls = [](const std::vector<RawTriangle>& triangles) {
    std::vector<Ball> out;
    for (const RawTriangle& t : triangles) {
      const Vec3 c = (t[0] + t[1] + t[2]) / 3.0;
      out.push_back({c, std::sqrt(std::max({(t[0] - c).squaredNorm(), (t[1] - c).squaredNorm(),
                                            (t[2] - c).squaredNorm()}))});
    }
    return out;
  };
  const std::vector<Ball> of_a = balls(a);
  const std::vector<Ball> of_b = balls(b);
  double best = cap;
  for (std::size_t j = 0; j < b.size(); ++j) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double reach = of_a[i].radius + of_b[j].radius + best;
      if ((of_a[i].centre - of_b[j].centre).squaredNorm() > reach * reach) continue;
      best = std::min(best, triangle_gap(a[i], b[j]));
    }
  }
  return best;
}

}  // namespace phalanx::test
