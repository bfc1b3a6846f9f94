// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_skin.h"

#include <algorithm>

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

/// Quaternions of the rotations R_WS R_SB of the segments from the bind pose. q and -q are the same rotation;
/// here each segment has the sign that is nearer to the segment before it, and a first segment to the palm.
std::array<Eigen::Vector4d, kSegments> quaternions(const std::array<Pose, kSegments>& X_WB) {
  std::array<Eigen::Vector4d, kSegments> q;
  for (std::size_t s = 0; s < kSegments; ++s) q[s] = Eigen::Quaterniond(X_WB[s].R).coeffs();
  for (std::size_t s = 0; s < kPalm; ++s) {
    const std::size_t before = s % kSegmentsPerDigit == 0 ? kPalm : s - 1;
    if (q[s].dot(q[before]) < 0.0) q[s] = -q[s];
  }
  return q;
}

/// Returns the centre of rotation of a vertex that several segments hold, in the bind pose.
Vec3 centre_of_rotation(const HandSkin& skin, std::size_t i) {
  const Vec3& p = skin.mesh.vertices[i];
  Vec3 sum = Vec3::Zero();
  double weights = 0.0;
  for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
    const std::size_t s = skin.segment[i][k];
    const auto weight = static_cast<double>(skin.weight[i][k]);
    if (s == kPalm || weight == 0.0) continue;
    const Pose& X_BS = skin.X_BS[s];
    const Vec3 along = X_BS.R.col(2);
    sum += weight * (X_BS.p + along.dot(p - X_BS.p) * along);
    weights += weight;
  }
  return weights > 0.0 ? Vec3(sum / weights) : p;
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
  std::array<Pose, kSegments> X_SB;
  for (std::size_t s = 0; s < kSegments; ++s) X_SB[s] = skin.X_BS[s].inverse();
  for (std::size_t i = 0; i < out.mesh.vertices.size(); ++i) {
    Vec3 fitted = Vec3::Zero();
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
      if (skin.weight[i][k] == 0.0F) continue;
      const std::size_t s = skin.segment[i][k];
      fitted += static_cast<double>(skin.weight[i][k]) *
                (out.X_BS[s] * fitted_point(base, fit, static_cast<int>(s), X_SB[s] * skin.mesh.vertices[i]));
    }
    out.mesh.vertices[i] = fitted;
  }
  return out;
}

std::vector<Vec3> skinned(const HandSkin& skin, const std::array<Pose, kSegments>& X_WS) {
  std::array<Pose, kSegments> X_WB;  // where each segment takes the frame B of the bind pose
  for (std::size_t s = 0; s < kSegments; ++s) X_WB[s] = X_WS[s] * skin.X_BS[s].inverse();
  const std::array<Eigen::Vector4d, kSegments> q = quaternions(X_WB);
  std::vector<Vec3> out;
  out.reserve(skin.mesh.vertices.size());
  for (std::size_t i = 0; i < skin.mesh.vertices.size(); ++i) {
    const Vec3& p = skin.mesh.vertices[i];
    const auto whole = std::ranges::find(skin.weight[i], 1.0F);
    if (whole != skin.weight[i].end()) {  // one segment holds it: rigid, without rounding by a quaternion
      const std::size_t s = skin.segment[i][static_cast<std::size_t>(whole - skin.weight[i].begin())];
      out.emplace_back(X_WS[s] * (skin.X_BS[s].inverse() * p));
      continue;
    }
    const Vec3 centre = centre_of_rotation(skin, i);
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
    Vec3 moved_centre = Vec3::Zero();
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
      const std::size_t s = skin.segment[i][k];
      rotation += static_cast<double>(skin.weight[i][k]) * q[s];
      moved_centre += static_cast<double>(skin.weight[i][k]) * (X_WB[s] * centre);
    }
    out.emplace_back(Eigen::Quaterniond(rotation.normalized()) * (p - centre) + moved_centre);
  }
  return out;
}

}  // namespace phalanx
