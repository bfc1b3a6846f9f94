// SPDX-License-Identifier: Apache-2.0
// Construction of a mesh ring by ring. Internal to src/mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Indices of the vertices around a closed curve. Neighbours are ring[i] and ring[i + 1], and the last
/// and the first.
using Ring = std::vector<std::int32_t>;

/// Builder of vertices, rings and strips of triangles between rings. Rings must run counter-clockwise about
/// an axis and follow each other along it. Then the triangles wind counter-clockwise seen from outside.
class MeshBuilder {
 public:
  std::int32_t vertex(const Vec3& p);
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) { mesh_.triangles.push_back({a, b, c}); }

  /// Adds a ring of `n` new vertices at point(0), ..., point(n - 1).
  Ring ring(int n, const std::function<Vec3(int)>& point);

  /// Adds the band between two rings. With equal counts it consists of quads, each cut along its shorter
  /// diagonal; cell j is left out if skip(j) is true. With unequal counts the triangles follow both rings at
  /// the same fraction of the turn.
  void strip(const Ring& lower, const Ring& upper, const std::function<bool(int)>& skip = nullptr);

  /// Adds the fan that closes the lower or upper end of the axis.
  void close_below(std::int32_t pole, const Ring& ring);
  void close_above(const Ring& ring, std::int32_t pole);

  [[nodiscard]] const Vec3& at(std::int32_t i) const { return mesh_.vertices[static_cast<std::size_t>(i)]; }

  /// Returns the mesh without unused vertices.
  [[nodiscard]] TriangleMesh take();

 private:
  TriangleMesh mesh_;
};

/// Checks that `value` is finite and above 0.
/// @throws std::invalid_argument with `maker` and `name` in its message, if it is not
void require_positive(double value, const char* maker, const char* name);

/// Allowed range of a ratio.
struct RatioRange {
  double min;
  double max;
};
/// Checks that `value` is within [range.min, range.max] times `reference`.
/// @throws std::invalid_argument if it is not
void require_ratio(double value, double reference, RatioRange range, const char* maker, const char* name,
                   const char* reference_name);

/// Checks that 1 <= triangles <= 50,000,000.
/// @throws std::invalid_argument if it is not
void require_triangles(int triangles, const char* maker);

/// Returns x rounded to the nearest multiple of `step`, at least `least`.
[[nodiscard]] int round_to(double x, int step, int least);

/// Returns cosine and sine of the fraction j/n of a full turn, exact at the quarter turns.
[[nodiscard]] Eigen::Vector2d unit_circle(int j, int n);

}  // namespace phalanx::mesh
