// SPDX-License-Identifier: Apache-2.0
// A continuous skin over the rigid segments, for the eye only: nothing collides with it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/hand/fit.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Linear blend skinning: at poses X_WS vertex i is  sum_k weight_ik X_WS[s_ik] X_SB[s_ik] vertex_i.
/// Bind pose B: the palm at the origin of the hand frame H, all joints at zero (the straight hand).
struct HandSkin {
  static constexpr std::size_t kInfluences = 4;
  TriangleMesh mesh;  ///< in the bind pose, frame H [m]
  std::vector<std::array<std::uint8_t, kInfluences>> segment;
  std::vector<std::array<float, kInfluences>> weight;  ///< sum 1; 0 where a vertex has fewer segments
  std::array<Pose, kSegments> X_BS;                    ///< the segments in the bind pose
};

/// The poses X_BS of a hand with these (a right hand's) numbers, with the palm at the identity.
/// @throws std::invalid_argument as HandModel for numbers that make no hand. Set-up only.
[[nodiscard]] std::array<Pose, kSegments> bind_poses(const HandParameters& parameters, Handedness handedness);

/// The mirror image in H's x = 0 plane, exactly: a right hand's skin becomes a left hand's, its poses too.
/// Twice is the identity, to the last bit. Set-up only.
void mirror(HandSkin& skin) noexcept;

/// Another person's skin, in that person's bind pose: each vertex is moved with each of its segments as
/// fitted_meshes() moves that segment's mesh, and the results are blended by the vertex's weights.
/// @param base  the hand that the skin belongs to
/// @param skin  of a right hand; so is the result
/// @throws std::invalid_argument as fitted_parameters(). Set-up only.
[[nodiscard]] HandSkin fitted_skin(const HandParameters& base, const HandFit& fit, const HandSkin& skin);

/// Where the skin's vertices are at poses X_WS [m]. What the cockpit's page computes, for tests. Set-up only.
[[nodiscard]] std::vector<Vec3> skinned(const HandSkin& skin, const std::array<Pose, kSegments>& X_WS);

}  // namespace phalanx
