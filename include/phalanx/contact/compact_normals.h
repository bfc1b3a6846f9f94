// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "phalanx/mesh/corner_normals.h"

namespace phalanx {

/// A mesh's normals, each different one kept once: the same bits as SurfaceNormals in a third of its memory.
/// On a smooth closed surface, which has half as many vertices as triangles, 24 bytes a triangle; 36 where
/// every triangle has one normal of its own. Constant.
class CompactNormals {
 public:
  /// Of no triangle.
  CompactNormals() = default;

  /// @throws std::length_error for 2^31 different normals or more. O(n) expected, deterministic; set-up only.
  explicit CompactNormals(const SurfaceNormals& normals);

  /// SurfaceNormals::corner[triangle][corner], unit [-]. Real-time.
  /// @pre 0 <= triangle < number of triangles, 0 <= corner < 3
  [[nodiscard]] Vec3 normal(int triangle, int corner) const noexcept {
    return normal_[entry(triangle, corner) & ~kOpen];
  }

  /// SurfaceNormals::open_edges[triangle]: bit k for the edge from corner k to the next one. Real-time.
  /// @pre 0 <= triangle < number of triangles
  [[nodiscard]] int open_edges(int triangle) const noexcept {
    int bits = 0;
    for (int k = 0; k < 3; ++k) bits |= (entry(triangle, k) & kOpen) != 0 ? 1 << k : 0;
    return bits;
  }

  /// Number of different normals.
  [[nodiscard]] std::size_t distinct() const noexcept { return normal_.size(); }

  /// Memory that it holds [bytes].
  [[nodiscard]] std::size_t bytes() const noexcept {
    return normal_.capacity() * sizeof(Vec3) + corner_.capacity() * sizeof(corner_[0]);
  }

 private:
  static constexpr std::uint32_t kOpen = 1U << 31;

  [[nodiscard]] std::uint32_t entry(int triangle, int corner) const noexcept {
    return corner_[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(corner)];
  }

  std::vector<Vec3> normal_;  ///< in the order in which the corners first show them
  std::vector<std::array<std::uint32_t, 3>>
      corner_;  ///< place in normal_; with kOpen where the edge from this corner to the next one is open
};

}  // namespace phalanx
