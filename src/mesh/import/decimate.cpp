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

/// Mesh as meshoptimizer reads it.
class FlatMesh {
 public:
  explicit FlatMesh(const TriangleMesh& mesh) : mesh_(mesh) {
    // Single precision relative to the box's corner affects only the order of the collapses.
    const Vec3 corner = bounds(mesh).min;
    position_.reserve(3 * mesh.vertices.size());
    for (const Vec3& v : mesh.vertices)
      for (int k = 0; k < 3; ++k) position_.push_back(static_cast<float>(v[k] - corner[k]));
    index_.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
      for (const std::int32_t v : t) index_.push_back(static_cast<unsigned>(v));
  }

  /// Collapses edges. @param options  of meshopt_simplify()
  [[nodiscard]] TriangleMesh collapsed(std::size_t triangles, unsigned options) const {
    std::vector<unsigned> left(index_.size());
    left.resize(meshopt_simplify(left.data(), index_.data(), index_.size(), position_.data(),
                                 mesh_.vertices.size(), kStride, 3 * triangles, 1.0F, options, nullptr));
    return take(left);
  }

  /// Joins the vertices of each cell of a grid, whatever surfaces they belong to.
  [[nodiscard]] TriangleMesh joined(std::size_t triangles) const {
    std::vector<unsigned> left(index_.size());
    left.resize(meshopt_simplifySloppy(left.data(), index_.data(), index_.size(), position_.data(),
                                       mesh_.vertices.size(), kStride, 3 * triangles, 1.0F, nullptr));
    return take(left);
  }

 private:
  static constexpr std::size_t kStride = 3 * sizeof(float);

  /// Returns the remaining triangles with the original's vertices in double precision.
  [[nodiscard]] TriangleMesh take(const std::vector<unsigned>& left) const {
    TriangleMesh out;
    std::vector<std::int32_t> number(mesh_.vertices.size(), -1);
    out.triangles.reserve(left.size() / 3);
    for (std::size_t i = 0; i + 2 < left.size(); i += 3) {
      Triangle t{};
      for (std::size_t k = 0; k < 3; ++k) {
        std::int32_t& n = number[left[i + k]];
        if (n < 0) {
          n = static_cast<std::int32_t>(out.vertices.size());
          out.vertices.push_back(mesh_.vertices[left[i + k]]);
        }
        t[k] = n;
      }
      out.triangles.push_back(t);
    }
    return out;
  }

  const TriangleMesh& mesh_;
  std::vector<float> position_;
  std::vector<unsigned> index_;
};

}  // namespace

TriangleMesh decimate(const TriangleMesh& mesh, int triangles, const std::string& origin) {
  const auto target = static_cast<std::size_t>(triangles);
  if (target >= mesh.triangles.size()) return mesh;
  const std::string remedy = "; ask for more, or for 0 to keep them all";
  if (target < 4)
    refuse(origin, "cannot be decimated to ", target, " triangles, no solid has fewer than 4", remedy);
  const FlatMesh flat(mesh);
  // Rims keep their place, unless too many triangles depend on them.
  TriangleMesh out = flat.collapsed(target, meshopt_SimplifyLockBorder);
  if (out.triangles.size() > target + target / 10) out = flat.collapsed(target, 0);
  if (out.triangles.size() > 2 * target)
    refuse(origin, "cannot be decimated to ", target,
           " triangles: open edges and edges of more than two triangles ", "hold ", out.triangles.size(),
           " of ", mesh.triangles.size(), " in place", remedy);
  if (out.triangles.size() < 4)
    refuse(origin, "decimated to ", target, " triangles, only ", out.triangles.size(), " are left", remedy);
  if (is_closed(mesh) && !is_closed(out))
    refuse(origin, "decimated to ", target, " triangles, the closed solid would open", remedy);
  const Bounds box = bounds(mesh);
  const Vec3 before = box.max - box.min;
  const Bounds now = bounds(out);
  for (int k = 0; k < 3; ++k) {
    if (now.max[k] - now.min[k] < 0.9 * before[k])
      refuse(origin, "decimated to ", target, " triangles, it would shrink from ", before[k] * 1e3, " to ",
             (now.max[k] - now.min[k]) * 1e3, " mm along ", "xyz"[k], remedy);
  }
  return out;
}

TriangleMesh picture_of(const TriangleMesh& mesh, std::size_t triangles) {
  if (triangles >= mesh.triangles.size()) return mesh;
  const FlatMesh flat(mesh);
  TriangleMesh out = flat.collapsed(triangles, 0);
  return out.triangles.size() <= 2 * triangles ? out : flat.joined(triangles);
}

}  // namespace phalanx::mesh
