// SPDX-License-Identifier: Apache-2.0
// Grows a mesh ring by ring. Internal to src/mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Indices of the vertices around a closed curve; ring[i] and ring[i + 1] are neighbours, and so are the last
/// and the first.
using Ring = std::vector<std::int32_t>;

/// Adds vertices, rings and strips of triangles between rings. With every ring running counter-clockwise
/// about an axis and the rings following each other along it, the triangles wind counter-clockwise seen from
/// outside.
class MeshBuilder {
 public:
  std::int32_t vertex(const Vec3& p);
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) { mesh_.triangles.push_back({a, b, c}); }

  /// A ring of `n` new vertices at point(0), ..., point(n - 1).
  Ring ring(int n, const std::function<Vec3(int)>& point);

  /// The band between two rings. Equal counts: quads, each cut along its shorter diagonal; cell j of it is
  /// left out where skip(j) says so. Unequal counts: the walk around both keeps pace by the fraction of the
  /// turn.
  void strip(const Ring& lower, const Ring& upper, const std::function<bool(int)>& skip = nullptr);

  /// The fan that closes the axis' lower or upper end.
  void close_below(std::int32_t pole, const Ring& ring);
  void close_above(const Ring& ring, std::int32_t pole);

  [[nodiscard]] const Vec3& at(std::int32_t i) const { return mesh_.vertices[static_cast<std::size_t>(i)]; }

  /// The mesh, without those vertices that no triangle names.
  [[nodiscard]] TriangleMesh take();

 private:
  TriangleMesh mesh_;
};

/// Throws std::invalid_argument unless `value` is finite and above 0. `maker` and `name` go into the message.
void require_positive(double value, const char* maker, const char* name);

/// Throws std::invalid_argument unless `value` is within [range.min, range.max] times `reference`.
struct RatioRange {
  double min;
  double max;
};
void require_ratio(double value, double reference, RatioRange range, const char* maker, const char* name,
                   const char* reference_name);

/// Throws std::invalid_argument unless 1 <= triangles <= 50,000,000.
void require_triangles(int triangles, const char* maker);

/// x rounded to the nearest multiple of `step`, at least `least`.
[[nodiscard]] int round_to(double x, int step, int least);

/// cos and sin of the fraction j/n of a full turn, exact at the quarter turns.
[[nodiscard]] Eigen::Vector2d unit_circle(int j, int n);

}  // namespace phalanx::mesh
