// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/corner_normals.h"

namespace phalanx {

/// Normals of a mesh, each distinct one stored once: the same bits as SurfaceNormals in a third of its
/// memory. A smooth closed surface has half as many vertices as triangles and takes 24 bytes a triangle. It
/// takes 36 where every triangle has a normal of its own. Constant.
class CompactNormals {
 public:
  /// Makes the normals of a mesh without triangles.
  CompactNormals() = default;

  /// Takes over the normals of a mesh. O(n) expected, deterministic; set-up only.
  /// @throws std::length_error if there are 2^31 distinct normals or more
  explicit CompactNormals(const SurfaceNormals& normals);

  /// Returns SurfaceNormals::corner[triangle][corner], a unit vector [-]. Real-time.
  /// @pre 0 <= triangle < number of triangles, 0 <= corner < 3
  [[nodiscard]] Vec3 normal(int triangle, int corner) const noexcept {
    return normal_[entry(triangle, corner) & ~kOpen];
  }

  /// Returns SurfaceNormals::open_edges[triangle]: bit k is set if the edge from corner k to the next one
  /// is open. Real-time.
  /// @pre 0 <= triangle < number of triangles
  [[nodiscard]] int open_edges(int triangle) const noexcept {
    int bits = 0;
    for (int k = 0; k < 3; ++k) bits |= (entry(triangle, k) & kOpen) != 0 ? 1 << k : 0;
    return bits;
  }

  /// Returns the number of distinct normals.
  [[nodiscard]] std::size_t distinct() const noexcept { return normal_.size(); }

  /// Returns the memory in use [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept {
    return normal_.capacity() * sizeof(Vec3) + corner_.capacity() * sizeof(corner_[0]);
  }

 private:
  static constexpr std::uint32_t kOpen = 1U << 31;

  [[nodiscard]] std::uint32_t entry(int triangle, int corner) const noexcept {
    return corner_[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(corner)];
  }

  std::vector<Vec3> normal_;  ///< in the order of their first use by a corner
  /// Index into normal_ for each corner, with the bit kOpen if the edge from it to the next corner is open.
  std::vector<std::array<std::uint32_t, 3>> corner_;
};

}  // namespace phalanx
