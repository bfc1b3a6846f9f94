// SPDX-License-Identifier: Apache-2.0
#include "mesh/repair/weld.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "mesh/repair/edge_table.h"

namespace phalanx::mesh {

TriangleMesh weld(const TriangleMesh& soup, WeldCounts* counts) {
  const std::size_t n = soup.vertices.size();
  const auto before = [&](std::int32_t a, std::int32_t b) {
    const Vec3& p = soup.vertices[idx(a)];
    const Vec3& q = soup.vertices[idx(b)];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  // The index as the last key makes the order stable without a stable sort's buffer.
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return before(a, b) || (!before(b, a) && a < b); });
  std::vector<std::int32_t> same(n);  // the first vertex at the same position
  for (std::size_t i = 0; i < n; ++i)
    same[idx(order[i])] = i > 0 && !before(order[i - 1], order[i]) ? same[idx(order[i - 1])] : order[i];
  order = {};

  WeldCounts counted;
  std::vector<bool> used(n, false);
  for (const Triangle& t : soup.triangles)
    for (const std::int32_t i : t) used[idx(i)] = true;
  const auto used_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  counted.unreferenced = n - used_vertices;
  std::vector<bool> stands(n, false);  // represents at least one used vertex
  for (std::size_t i = 0; i < n; ++i)
    if (used[i]) stands[idx(same[i])] = true;
  counted.duplicates =
      used_vertices - static_cast<std::size_t>(std::count(stands.begin(), stands.end(), true));
  used = {};
  stands = {};

  TriangleMesh out;
  out.triangles.reserve(soup.triangles.size());
  std::vector<std::int32_t> renumbered(n, -1);
  std::int32_t vertices = 0;
  for (const Triangle& t : soup.triangles) {
    Triangle welded{};
    for (std::size_t k = 0; k < 3; ++k) welded[k] = same[idx(t[k])];
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) {
      ++counted.degenerate;
      counted.longest_degenerate.take(longest_edge_of(soup, t));
      continue;
    }
    for (std::int32_t& i : welded) {
      std::int32_t& number = renumbered[idx(i)];
      if (number < 0) number = vertices++;
      i = number;
    }
    out.triangles.push_back(welded);
  }
  out.vertices.resize(idx(vertices));
  for (std::size_t i = 0; i < n; ++i)
    if (renumbered[i] >= 0) out.vertices[idx(renumbered[i])] = soup.vertices[i];
  if (counts != nullptr) *counts = counted;
  return out;
}

std::size_t rename_vertices(TriangleMesh& mesh, const std::vector<std::int32_t>& to,
                            std::vector<double>* values) {
  const std::size_t before = mesh.triangles.size();
  std::vector<bool> used(mesh.vertices.size(), false);
  std::size_t kept = 0;
  for (Triangle t : mesh.triangles) {
    for (std::int32_t& v : t) v = to[idx(v)];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (const std::int32_t v : t) used[idx(v)] = true;
    mesh.triangles[kept++] = t;
  }
  mesh.triangles.resize(kept);
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  std::int32_t vertices = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    mesh.vertices[idx(vertices)] = mesh.vertices[v];
    if (values != nullptr) (*values)[idx(vertices)] = (*values)[v];
    number[v] = vertices++;
  }
  mesh.vertices.resize(idx(vertices));
  if (values != nullptr) values->resize(idx(vertices));
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) v = number[idx(v)];
  return before - kept;
}

std::size_t drop_duplicate_faces(TriangleMesh& mesh, MeasuredFaces* dropped) {
  const std::size_t n = mesh.triangles.size();
  const auto sorted = [&](std::uint32_t t) {
    Triangle key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Triangle ka = sorted(a);
    const Triangle kb = sorted(b);
    return ka < kb || (ka == kb && a < b);
  });
  std::vector<bool> drop(n, false);
  for (std::size_t i = 1; i < n; ++i) drop[order[i]] = sorted(order[i - 1]) == sorted(order[i]);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < n; ++t) {
    if (drop[t]) {
      if (dropped != nullptr) dropped->add(mesh, mesh.triangles[t]);
      continue;
    }
    mesh.triangles[kept++] = mesh.triangles[t];
  }
  mesh.triangles.resize(kept);
  return n - kept;
}

}  // namespace phalanx::mesh
