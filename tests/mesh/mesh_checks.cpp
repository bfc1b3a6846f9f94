// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace phalanx::test {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;
using Corners = std::array<Vec3, 3>;

Corners corners(const TriangleMesh& mesh, std::size_t t) {
  Corners c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
  return c;
}

/// Six times the signed volume of a tetrahedron.
double orient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether the open segment pq passes through the triangle's inside or boundary. What lies in one plane but
/// for rounding is not counted.
bool pierces(const Vec3& p, const Vec3& q, const Corners& t) {
  const double area = (t[1] - t[0]).cross(t[2] - t[0]).norm();
  const double flat = 1e-9 * area * std::sqrt(area);
  const double side_p = orient(t[0], t[1], t[2], p);
  const double side_q = orient(t[0], t[1], t[2], q);
  if (!((side_p > flat && side_q < -flat) || (side_p < -flat && side_q > flat))) return false;
  const double a = orient(p, q, t[0], t[1]);
  const double b = orient(p, q, t[1], t[2]);
  const double c = orient(p, q, t[2], t[0]);
  return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

bool cross(const TriangleMesh& mesh, std::size_t s, std::size_t t) {
  const Triangle& ts = mesh.triangles[s];
  const Triangle& tt = mesh.triangles[t];
  const auto is_in = [](const Triangle& x, std::int32_t v) {
    return std::find(x.begin(), x.end(), v) != x.end();
  };
  const auto shared = std::count_if(ts.begin(), ts.end(), [&](std::int32_t v) { return is_in(tt, v); });
  const Corners cs = corners(mesh, s);
  const Corners ct = corners(mesh, t);
  if (shared == 3) return true;
  if (shared == 2) {  // folded onto each other: opposite normals to within a tenth of a degree
    const Vec3 ns = (cs[1] - cs[0]).cross(cs[2] - cs[0]).normalized();
    const Vec3 nt = (ct[1] - ct[0]).cross(ct[2] - ct[0]).normalized();
    return ns.dot(nt) < -0.9999985;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    // An edge that ends in a shared vertex touches there and cannot be told from a crossing; its opposite
    // edge can.
    if (!is_in(tt, ts[k]) && !is_in(tt, ts[n]) && pierces(cs[k], cs[n], ct)) return true;
    if (!is_in(ts, tt[k]) && !is_in(ts, tt[n]) && pierces(ct[k], ct[n], cs)) return true;
  }
  return false;
}

}  // namespace

int euler_characteristic(const TriangleMesh& mesh) {
  std::set<Edge> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.triangles.size());
}

std::string manifold_flaw(const TriangleMesh& mesh) {
  std::map<Edge, std::int32_t> opposite;  // directed edge -> the triangle's third vertex
  std::vector<int> degree(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++degree[static_cast<std::size_t>(t[k])];
      if (!opposite.emplace(Edge{t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]).second)
        return "edge " + std::to_string(t[k]) + "-" + std::to_string(t[(k + 1) % 3]) +
               " is run through twice";
    }
  }
  for (const auto& [edge, third] : opposite)
    if (!opposite.contains({edge.second, edge.first}))
      return "edge " + std::to_string(edge.first) + "-" + std::to_string(edge.second) + " has one triangle";
  std::vector<bool> walked(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t v = t[k];
      if (walked[static_cast<std::size_t>(v)]) continue;
      walked[static_cast<std::size_t>(v)] = true;
      int fan = 0;
      std::int32_t spoke = t[(k + 1) % 3];
      do {
        spoke = opposite.at({v, spoke});
        ++fan;
      } while (spoke != t[(k + 1) % 3] && fan <= degree[static_cast<std::size_t>(v)]);
      if (fan != degree[static_cast<std::size_t>(v)])
        return "vertex " + std::to_string(v) + " joins several fans";
    }
  }
  const auto unused = std::find(degree.begin(), degree.end(), 0);
  if (unused != degree.end())
    return "vertex " + std::to_string(unused - degree.begin()) + " is used by no triangle";
  return "";
}

double worst_shape(const TriangleMesh& mesh) {
  double worst = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners(mesh, t);
    const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    worst = std::min(worst, (c[1] - c[0]).cross(c[2] - c[0]).norm() / (longest * longest));
  }
  return worst;
}

std::size_t self_intersections(const TriangleMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  std::vector<Vec3> low(n);
  std::vector<Vec3> high(n);
  for (std::size_t t = 0; t < n; ++t) {
    const Corners c = corners(mesh, t);
    low[t] = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
    high[t] = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return low[a].x() < low[b].x(); });
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n && low[order[j]].x() <= high[order[i]].x(); ++j) {
      const std::size_t a = order[i];
      const std::size_t b = order[j];
      const bool apart = (low[a].array() > high[b].array()).any() || (low[b].array() > high[a].array()).any();
      if (!apart && cross(mesh, a, b)) ++count;
    }
  }
  return count;
}

std::vector<Vec3> corner_positions(const TriangleMesh& mesh) {
  std::vector<Vec3> all;
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) all.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return all;
}

Vec3 extents(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front();
  Vec3 high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return high - low;
}

}  // namespace phalanx::test
