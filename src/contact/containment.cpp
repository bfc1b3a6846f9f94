// SPDX-License-Identifier: Apache-2.0
#include "contact/containment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Returns per vertex the part that it belongs to, named by one of the part's vertices.
std::vector<std::int32_t> parts_of(const TriangleMesh& mesh) {
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
  for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = root(static_cast<std::int32_t>(v));
  return parent;
}

/// Returns the indices of the triangles, of equal ones the first, in their order.
std::vector<std::int32_t> different_triangles(const TriangleMesh& mesh) {
  struct Entry {
    Triangle corners;
    std::int32_t triangle;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  entries.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Entry entry{.corners = t, .triangle = static_cast<std::int32_t>(entries.size())};
    std::sort(entry.corners.begin(), entry.corners.end());
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end());
  std::vector<std::int32_t> different;
  different.reserve(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (i == 0 || entries[i].corners != entries[i - 1].corners) different.push_back(entries[i].triangle);
  std::sort(different.begin(), different.end());
  return different;
}

/// Returns per vertex whether it begins an edge that is not shared by exactly two of the triangles, which run
/// through it in opposite directions.
std::vector<bool> at_open_edges(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (const std::int32_t n : triangles) {
    const Triangle& t = mesh.triangles[idx(n)];
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<bool> open(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to] = edges[i];
    if (from == to || (i > 0 && edges[i] == edges[i - 1]) ||
        !std::binary_search(edges.begin(), edges.end(), std::pair{to, from}))
      open[idx(from)] = true;
  }
  return open;
}

/// Solid angle / 2 of a triangle seen from a point.
/// Van Oosterom & Strackee 1983: tan(solid angle / 2) = a . (b x c) / (abc + (a.b)c + (b.c)a + (c.a)b)
double half_solid_angle(const TriangleMesh& mesh, const Triangle& t, const Vec3& point) {
  const Vec3 a = mesh.vertices[idx(t[0])] - point;
  const Vec3 b = mesh.vertices[idx(t[1])] - point;
  const Vec3 c = mesh.vertices[idx(t[2])] - point;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

bool within(const Bounds& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

constexpr double kFullTurn = 2.0 * std::numbers::pi;  // 4 pi, in halves of solid angles

}  // namespace

double winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) sum += half_solid_angle(mesh, t, point);
  return sum / kFullTurn;
}

Containment::Containment(const TriangleMesh& object) : object_(&object) {
  const std::vector<std::int32_t> part = parts_of(object);
  const std::vector<std::int32_t> triangles = different_triangles(object);
  const std::vector<bool> at_open = at_open_edges(object, triangles);
  std::vector<bool> open(part.size(), false);
  for (std::size_t v = 0; v < part.size(); ++v)
    if (at_open[v]) open[idx(part[v])] = true;

  constexpr std::int32_t kNone = -1;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  std::vector<bool> seen(part.size(), false);
  std::vector<std::int32_t> closed(part.size(), kNone);
  for (const std::int32_t n : triangles) {
    const Triangle& t = object.triangles[idx(n)];
    const std::int32_t p = part[idx(t[0])];
    if (!seen[idx(p)]) {
      seen[idx(p)] = true;
      point_.push_back(object.vertices[idx(t[0])]);
      if (!open[idx(p)]) {
        closed[idx(p)] = static_cast<std::int32_t>(closed_.size());
        closed_.push_back({.box = {Vec3::Constant(kInf), Vec3::Constant(-kInf)}, .triangles = {}});
      }
    }
    if (open[idx(p)]) continue;
    ClosedPart& whole = closed_[idx(closed[idx(p)])];
    whole.triangles.push_back(n);
    for (const std::int32_t v : t) {
      whole.box.min = whole.box.min.cwiseMin(object.vertices[idx(v)]);
      whole.box.max = whole.box.max.cwiseMax(object.vertices[idx(v)]);
    }
  }
}

bool Containment::with(const TriangleMesh& segment, const Pose& X_WS) const {
  // The surfaces do not cross, and the segment and each part are connected: one point of each decides. The
  // absolute value admits an inside-out solid.
  const Vec3 on_segment = X_WS * segment.vertices.front();
  for (const ClosedPart& part : closed_) {
    if (!within(part.box, on_segment)) continue;
    double sum = 0.0;
    for (const std::int32_t n : part.triangles)
      sum += half_solid_angle(*object_, object_->triangles[idx(n)], on_segment);
    if (std::abs(sum) > 0.5 * kFullTurn) return true;
  }
  const Pose X_SW = X_WS.inverse();
  const Bounds box = bounds(segment);
  return std::any_of(point_.begin(), point_.end(), [&](const Vec3& on_part) {
    const Vec3 p = X_SW * on_part;
    return within(box, p) && std::abs(winding_number(segment, p)) > 0.5;
  });
}

}  // namespace phalanx
