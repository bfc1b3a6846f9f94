// SPDX-License-Identifier: Apache-2.0
#include "mesh/shapes/newell_teapot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/shapes/mesh_builder.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {
namespace {

/// A coordinate of the Bezier curve with these control points.
double cubic(double p0, double p1, double p2, double p3, double t) {
  const double s = 1.0 - t;
  return p0 * (s * s * s) + p1 * (3.0 * s * s * t) + p2 * (3.0 * s * t * t) + p3 * (t * t * t);
}

using ProfilePoint = std::array<double, 2>;
/// Control points (radius, z), four a piece. A piece's last is the next one's first.
constexpr std::array<std::array<ProfilePoint, 4>, 7> kProfile = {{
    {{{0.0, 0.0}, {1.425, 0.0}, {1.5, 0.075}, {1.5, 0.15}}},                           // bottom
    {{{1.5, 0.15}, {1.5, 0.225}, {2.0, 0.45}, {2.0, 0.9}}},                            // lower body
    {{{2.0, 0.9}, {2.0, 1.35}, {1.75, 1.875}, {1.5, 2.4}}},                            // upper body
    {{{1.5, 2.4}, {1.4375, 2.53125}, {1.3375, 2.53125}, {1.4, 2.4}}},                  // rim
    {{{1.4, 2.4}, {1.3666666666666667, 2.4}, {1.3333333333333333, 2.4}, {1.3, 2.4}}},  // bridge
    {{{1.3, 2.4}, {1.3, 2.55}, {0.4, 2.55}, {0.2, 2.7}}},                              // lid
    {{{0.2, 2.7}, {0.0, 2.85}, {0.8, 3.15}, {0.0, 3.15}}},                             // knob
}};

/// Half a tube, the one with y <= 0: control points (x, y, z), seven rows along (two patches that share the
/// fourth) and four around.
using HalfTube = std::array<std::array<std::array<double, 3>, 4>, 7>;

constexpr HalfTube kHandle = {{
    {{{-1.6, 0.0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0.0, 2.25}}},
    {{{-2.3, 0.0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0.0, 2.25}}},
    {{{-2.7, 0.0, 2.025}, {-2.7, -0.3, 2.025}, {-3.0, -0.3, 2.25}, {-3.0, 0.0, 2.25}}},
    {{{-2.7, 0.0, 1.8}, {-2.7, -0.3, 1.8}, {-3.0, -0.3, 1.8}, {-3.0, 0.0, 1.8}}},
    {{{-2.7, 0.0, 1.575}, {-2.7, -0.3, 1.575}, {-3.0, -0.3, 1.35}, {-3.0, 0.0, 1.35}}},
    {{{-2.5, 0.0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0.0, 0.9375}}},
    {{{-2.0, 0.0, 0.9}, {-2.0, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0.0, 0.6}}},
}};

constexpr HalfTube kSpout = {{
    {{{1.7, 0.0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0.0, 0.6}}},
    {{{2.6, 0.0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0.0, 0.825}}},
    {{{2.3, 0.0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0.0, 2.025}}},
    {{{2.7, 0.0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0.0, 2.4}}},
    {{{2.8, 0.0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0.0, 2.49375}}},
    {{{2.9, 0.0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0.0, 2.5125}}},
    {{{2.8, 0.0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0.0, 2.4}}},
}};

Vec3 on_tube(const HalfTube& tube, double a, double v) {
  const bool mirrored = a > 0.5;
  const double u = mirrored ? 2.0 - 2.0 * a : 2.0 * a;
  const std::size_t first = v < 0.5 ? 0 : 3;
  const double within = v < 0.5 ? 2.0 * v : 2.0 * v - 1.0;
  std::array<double, 3> p{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<double, 4> row{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& c = tube[first + i];
      row[i] = cubic(c[0][axis], c[1][axis], c[2][axis], c[3][axis], u);
    }
    p[axis] = cubic(row[0], row[1], row[2], row[3], within);
  }
  return {p[0], mirrored ? 0.0 - p[1] : p[1], p[2]};
}

/// Returns v at which the curve a = 1/2 of a tube is farthest along `direction`.
double farthest(const HalfTube& tube, double direction) {
  const auto x = [&](double v) { return direction * on_tube(tube, 0.5, v).x(); };
  constexpr int kSteps = 200;
  int best = 0;
  for (int i = 1; i <= kSteps; ++i)
    if (x(static_cast<double>(i) / kSteps) > x(static_cast<double>(best) / kSteps)) best = i;
  double low = static_cast<double>(best - 1) / kSteps;
  double high = static_cast<double>(best + 1) / kSteps;
  for (int i = 0; i < 100; ++i) {  // ternary search of the peak between the best sample's neighbours
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    (x(a) < x(b) ? low : high) = x(a) < x(b) ? a : b;
  }
  return 0.5 * (low + high);
}

}  // namespace

RevolvedSurface newell_body() {
  RevolvedSurface body;
  body.profile = [](double t) -> Eigen::Vector2d {
    const int piece = std::clamp(static_cast<int>(std::floor(t)), 0, static_cast<int>(kProfile.size()) - 1);
    const auto& c = kProfile[static_cast<std::size_t>(piece)];
    return {cubic(c[0][0], c[1][0], c[2][0], c[3][0], t - piece),
            cubic(c[0][1], c[1][1], c[2][1], c[3][1], t - piece)};
  };
  // Newell's quarter circles have the control points (1, 0), (1, k), (k, 1), (0, 1). He rounded k r to
  // his drawing's grid. All his body rings share k = 0.56: 0.2 k is written as 0.112, 1.3 k as 0.728, and
  // 2 k as 1.12.
  body.quarter = [](double q) -> Eigen::Vector2d {
    return {cubic(1.0, 1.0, 0.56, 0.0, q), cubic(0.0, 0.56, 1.0, 1.0, q)};
  };
  body.least_bands = {1, 2, 3, 2, 1, 2, 2};
  body.wall_begin = 1;
  body.wall_end = 3;
  return body;
}

Tube newell_handle() {
  Tube tube;
  tube.point = [](double a, double v) { return on_tube(kHandle, a, v); };
  tube.returns = true;
  tube.keep = farthest(kHandle, -1.0);
  return tube;
}

Tube newell_spout() {
  Tube tube;
  tube.point = [](double a, double v) { return on_tube(kSpout, a, v); };
  tube.returns = false;
  tube.keep = farthest(kSpout, 1.0);
  return tube;
}

}  // namespace phalanx::mesh

namespace phalanx {

TriangleMesh make_teapot(double length, int triangles) {
  mesh::require_positive(length, "make_teapot", "length");
  mesh::require_triangles(triangles, "make_teapot");
  const mesh::Tube handle = mesh::newell_handle();
  const mesh::Tube spout = mesh::newell_spout();
  TriangleMesh mesh =
      mesh::fit_stitched_solid(mesh::newell_body(), {handle, spout}, triangles, "make_teapot");
  // Newell's units become metres about the middle of the box; both ends in x are kept vertices.
  const double rear = handle.point(0.5, *handle.keep).x();
  const double front = spout.point(0.5, *spout.keep).x();
  const double scale = length / (front - rear);
  const Vec3 centre{0.5 * (front + rear), 0.0, 0.5 * mesh::kNewellHeight};
  for (Vec3& v : mesh.vertices) v = scale * (v - centre);
  return mesh;
}

}  // namespace phalanx
