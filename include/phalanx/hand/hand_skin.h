// SPDX-License-Identifier: Apache-2.0
// Continuous skin over the rigid segments, for display only. It takes no part in collisions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/hand/fit.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Skin of a hand, with centres of rotation: Le B. H., Hodgins J. K., "Real-time skeletal skinning with
/// optimized centers of rotation", ACM Trans. Graphics 35(4), 2016. At segment poses X_WS segment s has moved
/// by X_WS[s] X_SB[s], whose rotation is the unit quaternion q_s. Vertex i moves to
///   q (vertex_i - centre_i) + sum_k weight_ik X_WS[s_ik] X_SB[s_ik] centre_i,
/// with q the normalised sum_k weight_ik q_(s_ik), so its distance from its centre stays. The mean of the
/// moved vertices (linear blend skinning) loses 29 % of it half way between two segments at 90 deg.
/// The centres and the signs of q_s are our own. The paper finds centres by integrals over the whole surface.
/// Here centre_i is the weighted mean of the feet of the perpendiculars from vertex i to the axes (Z of S)
/// of its segments in the bind pose, without the palm's. At 24 random poses of the papers' hand the skin of
/// the fingers' roots stands out of the rigid segments by up to 3.1 mm, by linear blend skinning 2.6 mm, and
/// by dual quaternion skinning (Kavan L. et al. 2008), which turns it about the joints, 6.6 mm.
/// q_s and -q_s are the same rotation. q_s has the sign nearer to the segment before s in its digit, and of a
/// digit's first segment that nearer to the palm, so a finger bent by more than 180 deg in all blends the way
/// it was bent.
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
