// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/core/math.h"

namespace phalanx::mesh {

/// Largest size found so far, with its place.
struct Spot {
  double size = -1.0;      ///< [m]; negative: nothing was found
  Vec3 at = Vec3::Zero();  ///< in the mesh's frame [m]

  [[nodiscard]] bool known() const noexcept { return size >= 0.0; }
  /// Keeps the larger size; of equal sizes the first.
  void take(double other, const Vec3& place) noexcept {
    if (!(other > size)) return;
    size = other;
    at = place;
  }
  void take(const Spot& other) noexcept {
    if (other.known()) take(other.size, other.at);
  }
};

}  // namespace phalanx::mesh
