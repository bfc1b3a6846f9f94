// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/decimate.h"

#include <meshoptimizer.h>

#include <sstream>
#include <stdexcept>
#include <vector>

namespace phalanx::mesh {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const std::string& origin, const Parts&... parts) {
  std::ostringstream message;
  message << origin << ": ";
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

/// Returns the remaining triangles with the original's vertices in double precision.
TriangleMesh take(const TriangleMesh& mesh, const std::vector<unsigned>& index, std::size_t count) {
  TriangleMesh out;
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  out.triangles.reserve(count / 3);
  for (std::size_t i = 0; i + 2 < count; i += 3) {
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t& n = number[index[i + k]];
      if (n < 0) {
        n = static_cast<std::int32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[index[i + k]]);
      }
      t[k] = n;
    }
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

TriangleMesh decimate(const TriangleMesh& mesh, int triangles, const std::string& origin) {
  const auto target = static_cast<std::size_t>(triangles);
  if (target >= mesh.triangles.size()) return mesh;
  const std::string remedy = "; ask for more, or for 0 to keep them all";
  if (target < 4)
    refuse(origin, "cannot be decimated to ", target, " triangles, no solid has fewer than 4", remedy);
  // Single precision relative to the box's corner affects only the order of the collapses.
  const Bounds box = bounds(mesh);
  std::vector<float> position;
  position.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) position.push_back(static_cast<float>(v[k] - box.min[k]));
  std::vector<unsigned> index;
  index.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) index.push_back(static_cast<unsigned>(v));
  std::vector<unsigned> left(index.size());
  std::size_t count = 0;
  // Rims keep their place, unless too many triangles depend on them.
  for (const unsigned rims : {static_cast<unsigned>(meshopt_SimplifyLockBorder), 0U}) {
    count = meshopt_simplify(left.data(), index.data(), index.size(), position.data(), mesh.vertices.size(),
                             3 * sizeof(float), 3 * target, 1.0F, rims, nullptr);
    if (count / 3 <= target + target / 10) break;
  }
  TriangleMesh out = take(mesh, left, count);
  if (out.triangles.size() > 2 * target)
    refuse(origin, "cannot be decimated to ", target,
           " triangles: open edges and edges of more than two triangles ", "hold ", out.triangles.size(),
           " of ", mesh.triangles.size(), " in place", remedy);
  if (out.triangles.size() < 4)
    refuse(origin, "decimated to ", target, " triangles, only ", out.triangles.size(), " are left", remedy);
  if (is_closed(mesh) && !is_closed(out))
    refuse(origin, "decimated to ", target, " triangles, the closed solid would open", remedy);
  const Vec3 before = box.max - box.min;
  const Bounds now = bounds(out);
  for (int k = 0; k < 3; ++k) {
    if (now.max[k] - now.min[k] < 0.9 * before[k])
      refuse(origin, "decimated to ", target, " triangles, it would shrink from ", before[k] * 1e3, " to ",
             (now.max[k] - now.min[k]) * 1e3, " mm along ", "xyz"[k], remedy);
  }
  return out;
}

}  // namespace phalanx::mesh
