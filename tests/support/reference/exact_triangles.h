// SPDX-License-Identifier: Apache-2.0
// This folder has second, independent computations of the program's results. Tests compare the two.
// Here: the distance of triangles in extended precision, by other formulas than the program's, and the least
// one of all pairs of two meshes. No tree: what the contact search is held against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "phalanx/contact/triangle_distance.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using ExactTriangle = std::array<Real3, 3>;

inline ExactTriangle exact(const Corners& t) {
  return {t[0].cast<Real>(), t[1].cast<Real>(), t[2].cast<Real>()};
}

/// Squared distance of p from the segment that starts at `from`.
inline Real squared_to_edge(const Real3& p, const Real3& from, const Real3& along) {
  const Real length = along.squaredNorm();
  const Real share =
      length > 0.0L ? std::clamp(along.dot(p - from) / length, Real(0.0L), Real(1.0L)) : Real(0.0L);
  return (p - from - share * along).squaredNorm();
}

/// Least squared distance of two edges: of the four ends from the other edge, and of the inner points where
/// the common normal meets both.
inline Real squared_of_edges(const Real3& p, const Real3& u, const Real3& q, const Real3& v) {
  Real best = std::min(std::min(squared_to_edge(p, q, v), squared_to_edge(p + u, q, v)),
                       std::min(squared_to_edge(q, p, u), squared_to_edge(q + v, p, u)));
  const Real3 n = u.cross(v);
  const Real nn = n.squaredNorm();
  if (nn > 0.0L) {
    const Real s = (q - p).cross(v).dot(n) / nn;
    const Real t = (q - p).cross(u).dot(n) / nn;
    if (s >= 0.0L && s <= 1.0L && t >= 0.0L && t <= 1.0L)
      best = std::min(best, (p + s * u - q - t * v).squaredNorm());
  }
  return best;
}

/// Squared distance of the corners of `points` from the inside of `t`, and 0 where an edge of `points` goes
/// through it.
inline Real squared_to_face(const ExactTriangle& points, const ExactTriangle& t) {
  Real best = std::numeric_limits<Real>::infinity();
  const Real3 u = t[1] - t[0];
  const Real3 v = t[2] - t[0];
  const Real3 n = u.cross(v);
  const Real nn = n.squaredNorm();
  if (!(nn > 0.0L)) return best;
  const auto inside = [&](const Real3& p) {
    const Real b = (p - t[0]).cross(v).dot(n);
    const Real c = u.cross(p - t[0]).dot(n);
    return b >= 0.0L && c >= 0.0L && b + c <= nn;
  };
  std::array<Real, 3> height{};
  for (std::size_t i = 0; i < 3; ++i) {
    height[i] = n.dot(points[i] - t[0]);
    if (inside(points[i])) best = std::min(best, height[i] * height[i] / nn);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Real from = height[i];
    const Real to = height[(i + 1) % 3];
    if ((from > 0.0L && to < 0.0L) || (from < 0.0L && to > 0.0L)) {
      if (inside(points[i] + from / (from - to) * (points[(i + 1) % 3] - points[i]))) return 0.0L;
    }
  }
  return best;
}

inline double exact_gap(const ExactTriangle& a, const ExactTriangle& b) {
  Real best = std::min(squared_to_face(a, b), squared_to_face(b, a));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      best =
          std::min(best, squared_of_edges(a[i], a[(i + 1) % 3] - a[i], b[j], Real3(b[(j + 1) % 3] - b[j])));
    }
  }
  return static_cast<double>(std::sqrt(best));
}

inline std::vector<Corners> corners_of(const TriangleMesh& mesh, const Pose& X = {}) {
  std::vector<Corners> out;
  for (const Triangle& t : mesh.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = X * mesh.vertices[static_cast<std::size_t>(t[i])];
    out.push_back(corners);
  }
  return out;
}

/// Two triangles of two meshes and how far they are apart [m].
struct ExactPair {
  std::size_t a;
  std::size_t b;
  double gap;
};

/// Triangles with a ball around each, so that most pairs need not be measured.
class ExactMesh {
 public:
  explicit ExactMesh(const std::vector<Corners>& triangles) {
    for (const Corners& t : triangles) {
      const Vec3 c = (t[0] + t[1] + t[2]) / 3.0;
      double radius = 0.0;
      for (const Vec3& x : t) radius = std::max(radius, (x - c).norm());
      triangle_.push_back(exact(t));
      ball_.push_back({c, radius * (1.0 + 1e-12) + 1e-12});
      whole_.centre += c / static_cast<double>(triangles.size());
    }
    for (const Ball& b : ball_)
      whole_.radius = std::max(whole_.radius, (b.centre - whole_.centre).norm() + b.radius);
  }

  /// The least distance over all pairs [m], or `cap` if that is less.
  [[nodiscard]] double gap(const ExactMesh& other, double cap) const {
    double best = cap;
    for_each_near(other, best,
                  [&](std::size_t i, std::size_t j) { best = std::min(best, pair_gap(other, i, j)); });
    return best;
  }

  /// The least distance over all pairs [m]; infinite if there is none.
  [[nodiscard]] double gap(const ExactMesh& other) const {
    double nearest = std::numeric_limits<double>::infinity();
    if (triangle_.empty() || other.triangle_.empty()) return nearest;
    // No farther than the nearest balls' triangles: so few pairs are left to measure.
    std::array<std::size_t, 2> first{};
    for (std::size_t i = 0; i < ball_.size(); ++i) {
      for (std::size_t j = 0; j < other.ball_.size(); ++j) {
        const double apart =
            (ball_[i].centre - other.ball_[j].centre).norm() - ball_[i].radius - other.ball_[j].radius;
        if (apart >= nearest) continue;
        nearest = apart;
        first = {i, j};
      }
    }
    return gap(other, pair_gap(other, first[0], first[1]));
  }

  /// All pairs no farther apart than `limit` [m].
  [[nodiscard]] std::vector<ExactPair> pairs_within(const ExactMesh& other, double limit) const {
    std::vector<ExactPair> out;
    for_each_near(other, limit, [&](std::size_t i, std::size_t j) {
      const double found = pair_gap(other, i, j);
      if (found <= limit) out.push_back({i, j, found});
    });
    return out;
  }

 private:
  struct Ball {
    Vec3 centre;
    double radius;
  };

  [[nodiscard]] double pair_gap(const ExactMesh& other, std::size_t i, std::size_t j) const {
    return exact_gap(triangle_[i], other.triangle_[j]);
  }

  template <class Look>
  void for_each_near(const ExactMesh& other, const double& limit, Look&& look) const {
    for (std::size_t j = 0; j < other.ball_.size(); ++j) {
      const Ball& theirs = other.ball_[j];
      if (!meet(whole_, theirs, limit)) continue;
      for (std::size_t i = 0; i < ball_.size(); ++i) {
        if (meet(ball_[i], theirs, limit)) look(i, j);
      }
    }
  }

  [[nodiscard]] static bool meet(const Ball& a, const Ball& b, double limit) {
    const double reach = a.radius + b.radius + limit;
    return (a.centre - b.centre).squaredNorm() <= reach * reach;
  }

  std::vector<ExactTriangle> triangle_;
  std::vector<Ball> ball_;
  Ball whole_{Vec3::Zero(), 0.0};
};

}  // namespace phalanx::test
