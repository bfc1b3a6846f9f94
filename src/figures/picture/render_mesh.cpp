// SPDX-License-Identifier: Apache-2.0
#include "figures/picture/render_mesh.h"

#include <cmath>
#include <numbers>

#include "phalanx/mesh/corner_normals.h"

namespace phalanx::picture {
namespace {

/// @returns for each vertex whether all triangles around it agree on its normal.
std::vector<bool> smooth_vertices(const TriangleMesh& mesh, const std::vector<std::array<Vec3, 3>>& normals) {
  std::vector<bool> smooth(mesh.vertices.size(), true);
  std::vector<const Vec3*> first(mesh.vertices.size(), nullptr);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t][c]);
      if (first[v] == nullptr) {
        first[v] = &normals[t][c];
      } else if (first[v]->dot(normals[t][c]) < 1.0 - 1e-9) {
        smooth[v] = false;
      }
    }
  }
  return smooth;
}

/// Surface of the ten control points over barycentric (u, v, w), w at corner 0.
class CurvedPatch {
 public:
  CurvedPatch(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& n, const std::array<bool, 3>& bend)
      : p_(p) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (i == j) continue;
        edge_[i][j] = (2.0 * p[i] + p[j]) / 3.0;
        if (bend[i]) edge_[i][j] -= (p[j] - p[i]).dot(n[i]) / 3.0 * n[i];
      }
    }
    Vec3 edges = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) edges += edge_[i][(i + 1) % 3] + edge_[i][(i + 2) % 3];
    edges /= 6.0;
    centre_ = edges + (edges - (p[0] + p[1] + p[2]) / 3.0) / 2.0;
  }

  [[nodiscard]] Vec3 at(const Vec3& b) const {
    Vec3 x = 6.0 * b[0] * b[1] * b[2] * centre_;
    for (std::size_t i = 0; i < 3; ++i) {
      const double bi = b[static_cast<Eigen::Index>(i)];
      x += bi * bi * bi * p_[i];
      for (std::size_t j = 0; j < 3; ++j) {
        if (i != j) x += 3.0 * bi * bi * b[static_cast<Eigen::Index>(j)] * edge_[i][j];
      }
    }
    return x;
  }

 private:
  std::array<Vec3, 3> p_;
  std::array<std::array<Vec3, 3>, 3> edge_;
  Vec3 centre_;
};

Vec3 any_orthogonal(const Vec3& v) { return v.unitOrthogonal(); }

/// Ring of a surface of revolution: distance along the axis, radius, and the normal's component
/// along the axis.
struct Ring {
  double along, radius, normal_along;
};
void append_revolved(RenderMesh& out, const Vec3& base, const Vec3& axis, const std::vector<Ring>& rings,
                     int part) {
  constexpr int kSides = 24;
  const Vec3 e1 = any_orthogonal(axis);
  const Vec3 e2 = axis.cross(e1);
  const auto point = [&](const Ring& ring, int side, bool normal) -> Vec3 {
    const double a = 2.0 * std::numbers::pi * side / kSides;
    const Vec3 radial = std::cos(a) * e1 + std::sin(a) * e2;
    if (normal) {
      const double n = ring.normal_along;
      return n * axis + std::sqrt(std::max(0.0, 1.0 - n * n)) * radial;
    }
    return base + ring.along * axis + ring.radius * radial;
  };
  for (std::size_t r = 0; r + 1 < rings.size(); r += 2) {  // pairs of rings: a band with its own normals
    for (int side = 0; side < kSides; ++side) {
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      std::array<Vec3f, 4> normals;
      for (int k = 0; k < 4; ++k) {
        const Ring& ring = rings[r + static_cast<std::size_t>(k / 2)];
        out.vertices.push_back(point(ring, side + k % 2, false).cast<float>());
        out.albedo.push_back(Vec3f::Ones());
        normals[static_cast<std::size_t>(k)] = point(ring, side + k % 2, true).cast<float>();
      }
      out.triangles.push_back({first, first + 1, first + 2});
      out.normals.push_back({normals[0], normals[1], normals[2]});
      out.triangles.push_back({first + 1, first + 3, first + 2});
      out.normals.push_back({normals[1], normals[3], normals[2]});
      out.part.insert(out.part.end(), 2, part);
    }
  }
}

}  // namespace

void append_curved(RenderMesh& out, const TriangleMesh& mesh, const Pose& X, const CurvedLook& look) {
  if (mesh.triangles.empty()) return;
  const int level = look.level;
  const auto normals = corner_normals(mesh, look.crease);
  const auto smooth = smooth_vertices(mesh, normals);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> p;
    std::array<bool, 3> bend{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t][c]);
      p[c] = mesh.vertices[v];
      bend[c] = smooth[v];
    }
    const CurvedPatch patch(p, normals[t], bend);
    const int part = look.part ? look.part(t) : 0;
    // Row r has r + 1 points; corner 0 is at r = 0.
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    std::vector<Vec3f> point_normals;
    for (int r = 0; r <= level; ++r) {
      for (int c = 0; c <= r; ++c) {
        const Vec3 b(1.0 - static_cast<double>(r) / level, static_cast<double>(r - c) / level,
                     static_cast<double>(c) / level);
        const Vec3f point = (X * patch.at(b)).cast<float>();
        out.vertices.push_back(point);
        out.albedo.push_back(look.albedo ? look.albedo(t, b, point) : Vec3f::Ones());
        const Vec3 n = b[0] * normals[t][0] + b[1] * normals[t][1] + b[2] * normals[t][2];
        point_normals.push_back((X.R * n.normalized()).cast<float>());
      }
    }
    const auto index = [](int r, int c) { return static_cast<std::uint32_t>(r * (r + 1) / 2 + c); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      out.triangles.push_back({first + a, first + b, first + c});
      out.normals.push_back({point_normals[a], point_normals[b], point_normals[c]});
      out.part.push_back(part);
    };
    for (int r = 0; r < level; ++r) {
      for (int c = 0; c <= r; ++c) {
        add(index(r, c), index(r + 1, c), index(r + 1, c + 1));
        if (c < r) add(index(r, c), index(r + 1, c + 1), index(r, c + 1));
      }
    }
  }
}

void append_arrow(RenderMesh& out, const Vec3& tail, const Vec3& direction, double length,
                  double shaft_radius, int part) {
  const double head = std::min(0.45 * length, 6.0 * shaft_radius);
  const double head_radius = std::min(2.4 * shaft_radius, 0.5 * head);
  const double slope = head_radius / std::hypot(head, head_radius);
  const double neck = length - head;
  append_revolved(out, tail, direction,
                  {{0.0, shaft_radius, 0.0},
                   {neck, shaft_radius, 0.0},
                   {neck, shaft_radius, -1.0},
                   {neck, head_radius, -1.0},
                   {neck, head_radius, slope},
                   {length, 0.0, slope}},
                  part);
}

void append_ball(RenderMesh& out, const Vec3& centre, double radius, int part) {
  constexpr int kRings = 10;
  std::vector<Ring> rings;
  const auto ring = [&](int i) {
    const double a = std::numbers::pi * i / kRings;
    return Ring{-radius * std::cos(a), radius * std::sin(a), -std::cos(a)};
  };
  for (int i = 0; i < kRings; ++i) {
    rings.push_back(ring(i));
    rings.push_back(ring(i + 1));
  }
  append_revolved(out, centre, Vec3::UnitZ(), rings, part);
}

}  // namespace phalanx::picture
