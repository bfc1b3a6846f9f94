// SPDX-License-Identifier: Apache-2.0
// Solid of revolution with joined tubes (a mug's handle, a teapot's handle and spout): ONE closed 2-manifold.
// Mug and teapot are two descriptions for this code. Internal to src/mesh.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Surface of revolution  P(w, t) = (r(t) c(w), z(t)). Here w is the fraction of the turn. The parameter t
/// runs along the profile from the lower pole (r = 0) to the upper one, with integer t between pieces. The
/// outside is to the right of growing t.
struct RevolvedSurface {
  /// (r, z) at t in [0, pieces.size()]; r = 0 at both ends only.
  std::function<Eigen::Vector2d(double t)> profile;
  /// Section c(w) in the FIRST quarter, q in [0, 1] -> from (1, 0) to (0, 1). The other quarters
  /// are its rotations.
  std::function<Eigen::Vector2d(double q)> quarter;
  /// Least number of bands of each piece.
  std::vector<int> least_bands;
  /// The pieces [wall_begin, wall_end) are the wall, to which tubes are joined. On it t is a function of z.
  int wall_begin = 0;
  int wall_end = 0;

  /// Returns the section c at the fraction w of the turn, and the surface's point.
  [[nodiscard]] Eigen::Vector2d section(double w) const;
  [[nodiscard]] Vec3 point(double w, double t) const;
  /// Returns the wall's parameters (w in (-1/2, 1/2], t) for the direction and height of p.
  [[nodiscard]] Eigen::Vector2d locate_on_wall(const Vec3& p) const;
  /// Returns the radial distance of p from the wall, positive outside. p's height is clamped to the wall's.
  [[nodiscard]] double outside_wall(const Vec3& p) const;
};

/// Tube that starts inside the wall and leaves it. It either returns into the wall (a handle) or ends in a
/// flat section of its own (a spout).
struct Tube {
  /// a in [0, 1) around, v in [0, 1] along. Each curve of constant a crosses the wall once between v = 1/2
  /// and either end.
  std::function<Vec3(double a, double v)> point;
  bool returns = true;         ///< true: the end v = 1 is inside the wall; false: a disc closes it
  std::optional<double> keep;  ///< v on the curve a = 1/2 that requires a ring of vertices
  int least_around = 6;
  int least_along = 5;
};

/// Resolution: wanted edge length [unit of the surface], and points around the wall (a multiple of 4).
struct Resolution {
  double edge = 0.0;
  int around = 0;
  double margin = 0.45;  ///< least distance of a tube's ring from its hole's edge, in cells
};

/// Curves of constant a that carry a tube's vertices, each from wall to wall (or to the tip).
struct TubeCurves {
  std::vector<double> a;
  std::vector<double> start;  ///< v
  std::vector<double> end;    ///< v
};
/// Cache of these curves by tube and number of curves. At low resolution most time goes into their crossings
/// with the wall.
using CurveCache = std::vector<std::map<int, std::optional<TubeCurves>>>;

/// Builds the solid at a resolution. Returns nullopt if the wall's grid is too coarse for the tubes' holes.
[[nodiscard]] std::optional<TriangleMesh> build_stitched_solid(const RevolvedSurface& surface,
                                                               const std::vector<Tube>& tubes,
                                                               const Resolution& resolution,
                                                               CurveCache& cache);

/// Makes the solid with the grid whose triangle count is nearest to `triangles`, or the coarsest valid one.
/// `maker` names the object in messages.
[[nodiscard]] TriangleMesh fit_stitched_solid(const RevolvedSurface& surface, const std::vector<Tube>& tubes,
                                              int triangles, const char* maker);

/// Returns n + 1 parameters from a to b that cut the curve into n parts of equal length.
[[nodiscard]] std::vector<double> equal_arcs(const std::function<Vec3(double)>& curve, double a, double b,
                                             int n);
[[nodiscard]] double arc_length(const std::function<Vec3(double)>& curve, double a, double b);

}  // namespace phalanx::mesh
