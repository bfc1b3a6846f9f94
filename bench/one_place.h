// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "peer_engine.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::bench {

/// Whether all features (corners, edges, faces) of the tied pairs that are within kTie of the nearest pair's
/// distance meet at one place, to a tenth of kSamePoint: then the minimum is unique, and the contact's point
/// is that place whoever takes the mean.
/// @param segment  the segment's mesh, placed by X_WS
/// @param tied     the pairs within kTie, the nearest first
[[nodiscard]] bool one_place(const TriangleMesh& segment, const Pose& X_WS, const TriangleMesh& object,
                             const std::vector<ClosePair>& tied);

}  // namespace phalanx::bench
