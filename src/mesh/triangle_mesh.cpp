// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/triangle_mesh.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx {
namespace {

const Vec3& corner(const TriangleMesh& mesh, const Triangle& t, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(t[k])];
}

}  // namespace

TriangleMesh mesh_from_arrays(std::span<const double> coordinates, std::span<const std::int32_t> indices) {
  const auto refuse = [](const char* what, std::size_t count, const char* remedy) {
    throw std::invalid_argument("mesh_from_arrays: " + std::to_string(count) + " " + what +
                                ", not a multiple of three; " + remedy);
  };
  if (coordinates.size() % 3 != 0)
    refuse("coordinates", coordinates.size(), "give x, y and z of each vertex");
  if (indices.size() % 3 != 0) refuse("indices", indices.size(), "give three vertices for each triangle");
  TriangleMesh mesh;
  mesh.vertices.reserve(coordinates.size() / 3);
  mesh.triangles.reserve(indices.size() / 3);
  for (std::size_t i = 0; i < coordinates.size(); i += 3)
    mesh.vertices.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  for (std::size_t i = 0; i < indices.size(); i += 3)
    mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  check_mesh(mesh, "mesh_from_arrays");
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& part, const Pose& X) {
  const std::size_t first = mesh.vertices.size();
  if (first + part.vertices.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw std::invalid_argument(
        "append: the joined mesh would have more vertices than 32-bit indices reach; decimate it");
  // The sizes come first, because `part` may be `mesh` itself.
  const std::size_t vertices = part.vertices.size();
  const std::size_t triangles = part.triangles.size();
  mesh.vertices.reserve(first + vertices);
  mesh.triangles.reserve(mesh.triangles.size() + triangles);
  for (std::size_t i = 0; i < vertices; ++i) mesh.vertices.push_back(X * part.vertices[i]);
  const auto offset = static_cast<std::int32_t>(first);
  for (std::size_t i = 0; i < triangles; ++i) {
    const Triangle t = part.triangles[i];
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

bool is_closed(const TriangleMesh& mesh) {
  using Edge = std::pair<std::int32_t, std::int32_t>;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == t[(k + 1) % 3]) return false;
      edges.emplace_back(t[k], t[(k + 1) % 3]);
    }
  }
  std::sort(edges.begin(), edges.end());
  // A directed edge that occurs twice belongs to two triangles that run through it in the same direction.
  if (edges.empty() || std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](const Edge& e) {
    return std::binary_search(edges.begin(), edges.end(), Edge{e.second, e.first});
  });
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // Volumes are relative to a point of the mesh, so that a small mesh far from the origin
  // keeps its precision.
  const Vec3 o = mesh.vertices.front();
  double six_volumes = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = corner(mesh, t, 0) - o;
    const Vec3 b = corner(mesh, t, 1) - o;
    const Vec3 c = corner(mesh, t, 2) - o;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

Bounds bounds(const TriangleMesh& mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Bounds b{Vec3::Constant(kInf), Vec3::Constant(-kInf)};
  for (const Vec3& v : mesh.vertices) {
    b.min = b.min.cwiseMin(v);
    b.max = b.max.cwiseMax(v);
  }
  return b;
}

void check_mesh(const TriangleMesh& mesh, const char* name) {
  const auto refuse = [&](const auto&... parts) {
    std::ostringstream message;
    message.precision(17);
    message << name << ": ";
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  };
  const auto number = [](double x) { return std::isnan(x) ? std::abs(x) : x; };  // avoids "-nan"
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& v = mesh.vertices[i];
    if (!v.allFinite())
      refuse("vertex ", i, " is (", number(v.x()), ", ", number(v.y()), ", ", number(v.z()),
             "), not finite; repair the mesh or export it again");
  }
  const std::size_t count = mesh.vertices.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t index : mesh.triangles[i]) {
      if (index < 0 || static_cast<std::size_t>(index) >= count)
        refuse("triangle ", i, " names vertex ", index, ", but there are ", count,
               " vertices (counted from 0); repair the mesh or export it again");
    }
  }
  if (mesh.triangles.empty()) refuse("the mesh has no triangle; export a surface, not points or lines");
}

}  // namespace phalanx
