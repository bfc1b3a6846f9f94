// SPDX-License-Identifier: Apache-2.0
// The hand as triangles for the ray tracer: its skin, or its segments.
#pragma once

#include <array>

#include "figures/picture/render_mesh.h"
#include "phalanx/figures/picture.h"

namespace phalanx::picture {

using SegmentPoses = std::array<Pose, kSegments>;  ///< X_WS
using SegmentColours = std::array<Vec3f, kSegments>;

constexpr int kLevel = 4;  ///< number of parts into which each mesh edge is divided
constexpr float kLeastGhost =
    0.8e-3F;  ///< parts of the measured hand that are nearer to the displayed one are not drawn [m]

/// Appends the hand at poses X_WS. Colours blend at the border of two segments: on the skin by the vertices'
/// weights, and between rigid segments within 5 mm of their joint. A triangle belongs to the segment with
/// the largest weight.
void append_hand(RenderMesh& out, const DrawnHand& hand, const SegmentPoses& X_WS,
                 const SegmentColours& colours);

/// Appends the parts of the measured hand that are farther than kLeastGhost from the displayed one.
void append_ghost(RenderMesh& out, const DrawnHand& hand, const SegmentPoses& shown,
                  const SegmentPoses& measured);

}  // namespace phalanx::picture
