// SPDX-License-Identifier: Apache-2.0
// A solid of revolution with tubes (a mug's handle, a teapot's handle and spout) joined on: ONE closed
// 2-manifold. Internal to src/mesh; the mug and the teapot are two descriptions for the same code.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// What revolves. The surface is  P(w, t) = (r(t) c(w), z(t)),  w the fraction of the turn, t along the
/// profile from the lower pole (outside, r = 0) to the upper one; the profile's pieces meet at integer t. P's
/// outside is to the right of the growing t.
struct RevolvedSurface {
  /// (r, z) at t in [0, pieces.size()]; r = 0 at both ends only.
  std::function<Eigen::Vector2d(double t)> profile;
  /// The section c(w) for the FIRST quarter, q in [0, 1] -> from (1, 0) to (0, 1); the other quarters are its
  /// rotations.
  std::function<Eigen::Vector2d(double q)> quarter;
  /// For every piece the fewest bands that it may be cut into.
  std::vector<int> least_bands;
  /// The pieces [wall_begin, wall_end) are the wall that tubes join; on it t is a function of z.
  int wall_begin = 0;
  int wall_end = 0;

  [[nodiscard]] Eigen::Vector2d section(double w) const;
  [[nodiscard]] Vec3 point(double w, double t) const;
  /// The wall's parameters (w in (-1/2, 1/2], t) of the direction and height of p.
  [[nodiscard]] Eigen::Vector2d locate_on_wall(const Vec3& p) const;
  /// Distance of p from the wall, measured radially: positive outside. p's height is clamped to the wall's.
  [[nodiscard]] double outside_wall(const Vec3& p) const;
};

/// A tube that starts inside the wall, leaves it, and either comes back into it (a handle) or ends in a flat
/// section of its own (a spout).
struct Tube {
  /// a in [0, 1) around, v in [0, 1] along. Curves of constant a cross the wall once between either end and v
  /// = 1/2.
  std::function<Vec3(double a, double v)> point;
  bool returns = true;         ///< the end v = 1 is inside the wall; else it is closed by a disc
  std::optional<double> keep;  ///< v on the curve a = 1/2 at which there must be a ring of vertices
  int least_around = 6;
  int least_along = 5;
};

/// How fine: the wanted edge length [unit of the surface], and points around the wall (a multiple of 4).
struct Resolution {
  double edge = 0.0;
  int around = 0;
  double margin = 0.45;  ///< cells between a tube's ring and the edge of its hole, at least
};

/// The curves of constant a that carry a tube's vertices, each from wall to wall (or to the tip).
struct TubeCurves {
  std::vector<double> a;
  std::vector<double> start;  ///< v
  std::vector<double> end;    ///< v
};
/// Per tube and number of curves, once found: where the curves cross the wall is what costs most at low
/// resolution.
using CurveCache = std::vector<std::map<int, std::optional<TubeCurves>>>;

/// nullopt where the wall's grid is too coarse for the tubes' holes.
[[nodiscard]] std::optional<TriangleMesh> build_stitched_solid(const RevolvedSurface& surface,
                                                               const std::vector<Tube>& tubes,
                                                               const Resolution& resolution,
                                                               CurveCache& cache);

/// The grid whose triangle count is nearest to `triangles`, or the coarsest valid one. `maker` names the
/// object in messages.
[[nodiscard]] TriangleMesh fit_stitched_solid(const RevolvedSurface& surface, const std::vector<Tube>& tubes,
                                              int triangles, const char* maker);

/// n + 1 parameters from a to b that cut the curve into n parts of equal length.
[[nodiscard]] std::vector<double> equal_arcs(const std::function<Vec3(double)>& curve, double a, double b,
                                             int n);
[[nodiscard]] double arc_length(const std::function<Vec3(double)>& curve, double a, double b);

}  // namespace phalanx::mesh
