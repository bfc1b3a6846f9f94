// SPDX-License-Identifier: Apache-2.0
// How fast the normal of a mesh may turn, worked out from its triangles by looking at every one of them: what
// a force that is felt on the mesh is held against.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "phalanx/mesh/corner_normals.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

inline double angle_of(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// The point of triangle abc nearest to p, by regions (vertex, edge, face).
inline Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto on_segment = [&](const Vec3& s, const Vec3& e) {
    const Vec3 d = e - s;
    const double dd = d.squaredNorm();
    return dd > 0.0 ? Vec3(s + std::clamp(d.dot(p - s) / dd, 0.0, 1.0) * d) : s;
  };
  const Vec3 n = (b - a).cross(c - a);
  const double nn = n.squaredNorm();
  if (nn > 0.0) {
    const Vec3 foot = p - n * (n.dot(p - a) / nn);
    const bool inside = n.dot((b - a).cross(foot - a)) >= 0.0 && n.dot((c - b).cross(foot - b)) >= 0.0 &&
                        n.dot((a - c).cross(foot - c)) >= 0.0;
    if (inside) return foot;
  }
  Vec3 best = on_segment(a, b);
  for (const Vec3& q : {on_segment(b, c), on_segment(c, a)}) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

class SurfaceBound {
 public:
  explicit SurfaceBound(const TriangleMesh& mesh, double crease_angle) : mesh_(mesh) {
    corner_ = corner_normals(mesh, crease_angle);
    const auto& corner = corner_;
    patch_.resize(mesh.triangles.size());
    std::iota(patch_.begin(), patch_.end(), std::size_t{0});
    std::map<std::pair<int, int>, std::vector<std::size_t>> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto v = points(t);
      const Vec3 area = (v[1] - v[0]).cross(v[2] - v[0]);
      face_.push_back(area.norm() > 0.0 ? Vec3(area.normalized()) : Vec3(Vec3::Zero()));
      // n(x) = sum N_i w_i(x) on the triangle; the gradient of w_i is area x opposite edge / |area|^2.
      Mat3 gradient = Mat3::Zero();
      double shortest = 1.0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (area.squaredNorm() > 0.0) {
          const Vec3 opposite = v[(i + 2) % 3] - v[(i + 1) % 3];
          gradient += corner[t][i] * area.cross(opposite).transpose() / area.squaredNorm();
        }
        shortest = std::min(shortest, std::cos(0.5 * angle_of(corner[t][i], corner[t][(i + 1) % 3])));
      }
      // The interpolated normal is no shorter than its least component along the mean of the corners.
      const Vec3 mean = (corner[t][0] + corner[t][1] + corner[t][2]).normalized();
      for (const Vec3& n : corner[t]) shortest = std::min(shortest, n.dot(mean));
      const double longest = std::max({(v[1] - v[0]).norm(), (v[2] - v[1]).norm(), (v[0] - v[2]).norm()});
      const bool sliver = area.norm() < 1e-6 * longest;  // lower than 1 um: the contact is never inside it
      turn_.push_back(sliver ? 0.0 : gradient.jacobiSvd().singularValues()[0] / std::max(shortest, 1e-3));
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = mesh.triangles[t][k];
        const int b = mesh.triangles[t][(k + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}].push_back(t);
      }
    }
    for (const auto& [edge, faces] : edges) {
      const double fold = faces.size() == 2 ? angle_of(face_[faces[0]], face_[faces[1]]) : std::numbers::pi;
      if (fold <= crease_angle + 1e-6) {
        patch_[patch_of(faces[0])] = patch_of(faces[1]);
        continue;
      }
      if (faces.size() == 1) add_rim(edge, faces[0]);
      creases_.push_back({mesh.vertices[static_cast<std::size_t>(edge.first)],
                          mesh.vertices[static_cast<std::size_t>(edge.second)], fold});
    }
  }

  /// Greatest turn of the interpolated normal per length over the triangles within `radius` of p [rad/m].
  [[nodiscard]] double turn_near(const Vec3& p, double radius) const {
    double most = 0.0;
    for_each_near(p, radius, [&](std::size_t t) { most = std::max(most, turn_[t]); });
    return most;
  }
  /// Greatest fold within `radius` of p over which normals are not interpolated [rad]: of an edge, pi at a
  /// rim, or between faces there that no smooth way joins, such as shells that run through each other.
  [[nodiscard]] double crease_near(const Vec3& p, double radius) const {
    double most = 0.0;
    for (const Crease& c : creases_) {
      if (c.fold > most && (nearest_on_triangle(p, c.a, c.b, c.b) - p).norm() <= radius) most = c.fold;
    }
    std::vector<std::size_t> near;
    for_each_near(p, radius, [&](std::size_t t) { near.push_back(t); });
    for (const std::size_t a : near) {
      for (const std::size_t b : near)
        if (patch_of(a) != patch_of(b)) most = std::max(most, angle_of(face_[a], face_[b]));
    }
    return most;
  }
  /// Greatest angle between the planes of faces within `radius` of p or of q [rad].
  [[nodiscard]] double spread(const Vec3& p, const Vec3& q, double radius) const {
    std::vector<Vec3> normals;
    for (const Vec3& x : {p, q})
      for_each_near(x, radius, [&](std::size_t t) { normals.push_back(face_[t]); });
    double most = 0.0;
    for (const Vec3& a : normals) {
      for (const Vec3& b : normals) most = std::max(most, angle_of(a, b));
    }
    return most;
  }

  /// The object's point nearest to p.
  [[nodiscard]] Vec3 nearest(const Vec3& p) const { return nearest_of(p).second; }
  /// The plane's normal of the face nearest to p, on the side of `side`.
  [[nodiscard]] Vec3 face_nearest(const Vec3& p, const Vec3& side) const {
    return towards(face_[nearest_of(p).first], side);
  }
  /// What the surface offers within `radius` of p, on the side of `side`: each face's interpolated normal at
  /// its point nearest to p, and out of a rim the direction across it.
  [[nodiscard]] std::vector<Vec3> fan(const Vec3& p, double radius, const Vec3& side) const {
    std::vector<Vec3> out;
    for_each_near(p, radius, [&](std::size_t t) {
      const auto v = points(t);
      const Vec3 foot = nearest_on_triangle(p, v[0], v[1], v[2]);
      const Vec3 area = (v[1] - v[0]).cross(v[2] - v[0]);
      Vec3 n = Vec3::Zero();
      for (std::size_t i = 0; i < 3; ++i)
        n += corner_[t][i] * area.dot((v[(i + 2) % 3] - v[(i + 1) % 3]).cross(foot - v[(i + 1) % 3]));
      if (n.norm() > 0.0) out.push_back(towards(n.normalized(), side));
    });
    for (const Rim& rim : rims_)
      if ((nearest_on_triangle(p, rim.a, rim.b, rim.b) - p).norm() <= radius) out.push_back(rim.out);
    return out;
  }

 private:
  struct Rim {
    Vec3 a, b, out;
  };
  static Vec3 towards(const Vec3& n, const Vec3& side) { return n.dot(side) < 0.0 ? Vec3(-n) : n; }
  [[nodiscard]] std::pair<std::size_t, Vec3> nearest_of(const Vec3& p) const {
    std::pair<std::size_t, Vec3> best{0, Vec3::Constant(1e9)};
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto v = points(t);
      const Vec3 foot = nearest_on_triangle(p, v[0], v[1], v[2]);
      if ((foot - p).squaredNorm() < (best.second - p).squaredNorm()) best = {t, foot};
    }
    return best;
  }
  void add_rim(const std::pair<int, int>& edge, std::size_t face) {
    const Vec3& a = mesh_.vertices[static_cast<std::size_t>(edge.first)];
    const Vec3& b = mesh_.vertices[static_cast<std::size_t>(edge.second)];
    const auto v = points(face);
    Vec3 out = (b - a).cross(face_[face]).normalized();
    if (out.dot(v[0] + v[1] + v[2] - 3.0 * a) > 0.0) out = -out;
    rims_.push_back({a, b, out});
  }
  /// Faces that smooth edges join share one.
  [[nodiscard]] std::size_t patch_of(std::size_t t) const {
    while (patch_[t] != t) t = patch_[t];
    return t;
  }
  struct Crease {
    Vec3 a, b;
    double fold;
  };
  [[nodiscard]] std::array<Vec3, 3> points(std::size_t t) const {
    const Triangle& triangle = mesh_.triangles[t];
    return {mesh_.vertices[static_cast<std::size_t>(triangle[0])],
            mesh_.vertices[static_cast<std::size_t>(triangle[1])],
            mesh_.vertices[static_cast<std::size_t>(triangle[2])]};
  }
  template <class Use>
  void for_each_near(const Vec3& p, double radius, Use&& use) const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto v = points(t);
      if ((nearest_on_triangle(p, v[0], v[1], v[2]) - p).norm() <= radius) use(t);
    }
  }

  const TriangleMesh& mesh_;
  std::vector<Vec3> face_;
  std::vector<double> turn_;
  std::vector<Crease> creases_;
  std::vector<Rim> rims_;
  std::vector<std::array<Vec3, 3>> corner_;
  std::vector<std::size_t> patch_;
};

}  // namespace phalanx::test
