// SPDX-License-Identifier: Apache-2.0
#include "contact/containment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Returns the mesh's closed parts, connected by shared vertices. A triangle that occurs twice counts once.
/// An open sheet contains nothing.
std::vector<TriangleMesh> closed_parts(const TriangleMesh& mesh) {
  std::vector<std::int32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t v) {
    while (parent[idx(v)] != v) v = parent[idx(v)] = parent[idx(parent[idx(v)])];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[idx(root(t[1]))] = root(t[0]);
    parent[idx(root(t[2]))] = root(t[0]);
  }
  std::map<std::int32_t, std::vector<Triangle>> parts;
  std::set<Triangle> seen;
  for (const Triangle& t : mesh.triangles) {
    Triangle key = t;
    std::sort(key.begin(), key.end());
    if (seen.insert(key).second) parts[root(t[0])].push_back(t);
  }
  std::vector<TriangleMesh> closed;
  for (auto& [name, triangles] : parts) {
    TriangleMesh part;
    std::map<std::int32_t, std::int32_t> number;
    for (Triangle& t : triangles) {
      for (std::int32_t& v : t) {
        const auto [at, is_new] = number.try_emplace(v, static_cast<std::int32_t>(part.vertices.size()));
        if (is_new) part.vertices.push_back(mesh.vertices[idx(v)]);
        v = at->second;
      }
    }
    part.triangles = std::move(triangles);
    if (is_closed(part)) closed.push_back(std::move(part));
  }
  return closed;
}

}  // namespace

double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    // Van Oosterom & Strackee 1983: tan(solid angle / 2) = a . (b x c) / (abc + (a.b)c + (b.c)a + (c.a)b)
    const Vec3 a = mesh.vertices[idx(t[0])] - point;
    const Vec3 b = mesh.vertices[idx(t[1])] - point;
    const Vec3 c = mesh.vertices[idx(t[2])] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

Containment::Containment(const TriangleMesh& object) : closed_(closed_parts(object)) {
  std::vector<bool> used(object.vertices.size(), false);
  for (const Triangle& t : object.triangles) {
    for (const std::int32_t v : t) used[idx(v)] = true;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) points_.push_back(object.vertices[v]);
  }
}

bool Containment::with(const TriangleMesh& segment, const Pose& X_WS) const {
  if (points_.empty()) return false;
  // The surfaces do not cross, and a segment is connected: one of its vertices decides. The absolute value
  // admits an inside-out solid.
  for (const TriangleMesh& part : closed_) {
    if (std::abs(winding_number(part, X_WS * segment.vertices.front())) > 0.5) return true;
  }
  const Pose X_SW = X_WS.inverse();
  const Bounds box = bounds(segment);
  for (const Vec3& v : points_) {
    const Vec3 p = X_SW * v;
    const bool in_box = (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
    if (in_box && std::abs(winding_number(segment, p)) > 0.5) return true;
  }
  return false;
}

}  // namespace phalanx
