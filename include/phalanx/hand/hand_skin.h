// SPDX-License-Identifier: Apache-2.0
// Continuous skin over the rigid segments, for display only. It takes no part in collisions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/hand/fit.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Skin of a hand for linear blend skinning. At segment poses X_WS vertex i is
///   sum_k weight_ik X_WS[s_ik] X_SB[s_ik] vertex_i.
/// In the bind pose B the palm is at the origin of the hand frame H, and all joint angles are zero.
struct HandSkin {
  static constexpr std::size_t kInfluences = 4;
  TriangleMesh mesh;  ///< in the bind pose, frame H [m]
  std::vector<std::array<std::uint8_t, kInfluences>> segment;
  std::vector<std::array<float, kInfluences>> weight;  ///< sum 1; 0 in unused places
  std::array<Pose, kSegments> X_BS;                    ///< poses of the segments in the bind pose
};

/// Returns the bind poses X_BS of a hand with the given numbers (of a right hand), with the palm
/// at the identity.
/// @throws std::invalid_argument if HandModel rejects the numbers. Set-up only.
[[nodiscard]] std::array<Pose, kSegments> bind_poses(const HandParameters& parameters, Handedness handedness);

/// Mirrors a right hand's skin exactly in H's plane x = 0 to a left hand's, its bind poses included. Applied
/// twice, it gives the same bits again. Set-up only.
void mirror(HandSkin& skin) noexcept;

/// Returns the skin fitted to a person, in that person's bind pose. Each of a vertex's segments moves it as
/// fitted_meshes() moves that segment's mesh; the vertex's weights blend the results.
/// @param base  the hand that the skin belongs to
/// @param skin  skin of a right hand; the result is also of a right hand
/// @throws std::invalid_argument if fitted_parameters() rejects the fit. Set-up only.
[[nodiscard]] HandSkin fitted_skin(const HandParameters& base, const HandFit& fit, const HandSkin& skin);

/// Returns the skin's vertices at segment poses X_WS, in W [m]. Pictures use this; the cockpit's page
/// computes the same. Set-up only.
[[nodiscard]] std::vector<Vec3> skinned(const HandSkin& skin, const std::array<Pose, kSegments>& X_WS);

}  // namespace phalanx
