// SPDX-License-Identifier: Apache-2.0
// The map of fitted_meshes() for one point, for other geometry that follows the meshes.
#pragma once

#include "phalanx/hand/fit.h"

namespace phalanx {

/// Returns where fitted_meshes() moves the point p_S of a segment, in the segment's frame S [m].
[[nodiscard]] Vec3 fitted_point(const HandParameters& base, const HandFit& fit, int segment,
                                const Vec3& p_S) noexcept;

}  // namespace phalanx
