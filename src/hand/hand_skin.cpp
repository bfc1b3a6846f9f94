// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_skin.h"

#include "hand/fit_point.h"
#include "phalanx/hand/hand_meshes.h"

namespace phalanx {
namespace {

/// Returns the meshes that the constructor of HandModel requires; no pose depends on them.
SegmentMeshes any_meshes() {
  SegmentMeshes meshes;
  meshes.fill({.vertices = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, .triangles = {{0, 1, 2}}});
  return meshes;
}

/// Returns the skin's vertices in W, blended by weight. Here map(s, p) moves the point p in s's bind pose
/// frame as segment s alone moves it.
template <typename Map>
std::vector<Vec3> blended(const HandSkin& skin, Map&& map) {
  std::array<Pose, kSegments> X_SB;
  for (std::size_t s = 0; s < kSegments; ++s) X_SB[s] = skin.X_BS[s].inverse();
  std::vector<Vec3> out(skin.mesh.vertices.size(), Vec3::Zero());
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
      if (skin.weight[i][k] == 0.0F) continue;
      const std::size_t s = skin.segment[i][k];
      out[i] += static_cast<double>(skin.weight[i][k]) * map(s, X_SB[s] * skin.mesh.vertices[i]);
    }
  }
  return out;
}

}  // namespace

std::array<Pose, kSegments> bind_poses(const HandParameters& parameters, Handedness handedness) {
  const HandModel hand(parameters, handedness, {}, any_meshes());
  HandPoses straight;
  hand.poses(JointArray{}, straight);
  std::array<Pose, kSegments> X_BS;
  for (int d = 0; d < kDigits; ++d) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      X_BS[static_cast<std::size_t>(segment_index(d, k))] =
          straight.digit[static_cast<std::size_t>(d)].segment[static_cast<std::size_t>(k)];
    }
  }
  return X_BS;
}

void mirror(HandSkin& skin) noexcept {
  mirror(skin.mesh);
  // X' = M X M with M = diag(-1, 1, 1): in R the entries that couple x to y and z change their signs.
  for (Pose& X : skin.X_BS) {
    X.R.row(0) = -X.R.row(0);
    X.R.col(0) = -X.R.col(0);
    X.p.x() = -X.p.x();
  }
}

HandSkin fitted_skin(const HandParameters& base, const HandFit& fit, const HandSkin& skin) {
  HandSkin out = skin;
  out.X_BS = bind_poses(fitted_parameters(base, fit), Handedness::kRight);
  out.mesh.vertices = blended(skin, [&](std::size_t s, const Vec3& p_S) {
    return Vec3(out.X_BS[s] * fitted_point(base, fit, static_cast<int>(s), p_S));
  });
  return out;
}

std::vector<Vec3> skinned(const HandSkin& skin, const std::array<Pose, kSegments>& X_WS) {
  return blended(skin, [&](std::size_t s, const Vec3& p_S) { return Vec3(X_WS[s] * p_S); });
}

}  // namespace phalanx
