// SPDX-License-Identifier: Apache-2.0
#include "record/recording/geometry_message.h"

#include "phalanx/station/session.h"

namespace phalanx {
namespace {

void put(const TriangleMesh& mesh, wire::Mesh& out) {
  out.mutable_position()->Reserve(static_cast<int>(3 * mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) out.add_position(static_cast<float>(v[k]));
  }
  out.mutable_index()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t i : t) out.add_index(static_cast<std::uint32_t>(i));
  }
}

/// Adds position and unit quaternion x y z w, like the poses of a Tick.
void put(const Pose& X, wire::Skin& out) {
  const Eigen::Quaterniond q(X.R);
  for (int k = 0; k < 3; ++k) out.add_bind_pose(static_cast<float>(X.p[k]));
  for (const double c : {q.x(), q.y(), q.z(), q.w()}) out.add_bind_pose(static_cast<float>(c));
}

void put(const HandSkin& skin, wire::Skin& out) {
  put(skin.mesh, *out.mutable_mesh());
  for (std::size_t i = 0; i < skin.mesh.vertices.size(); ++i) {
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
      out.add_segment(skin.segment[i][k]);
      out.add_weight(skin.weight[i][k]);
    }
  }
  for (const Pose& X : skin.X_BS) put(X, out);
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

bool same(const SegmentMeshes& a, const SegmentMeshes& b) {
  for (std::size_t s = 0; s < kSegments; ++s) {
    if (!same(a[s], b[s])) return false;
  }
  return true;
}

// add_joint_name(std::string&&) would leave the message broken where memory is short (protobuf 3.21 counts the
// element before it makes it).
void put_joints(const HandParameters& hand, wire::Geometry& out) {
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    out.add_joint_name()->assign(joint_name(j));
    out.add_joint_min(static_cast<float>(hand.min_angle[i]));
    out.add_joint_max(static_cast<float>(hand.max_angle[i]));
    out.add_joint_open(static_cast<float>(hand.open_angle[i]));
  }
}

}  // namespace

void write_geometry(const SessionGeometry& geometry, wire::Geometry& out) {
  out.Clear();
  out.set_revision(geometry.revision);
  out.set_left(geometry.handedness == Handedness::kLeft);
  for (const TriangleMesh& mesh : geometry.segment) put(mesh, *out.add_segment());
  if (!same(geometry.display, geometry.segment)) {
    for (const TriangleMesh& mesh : geometry.display) put(mesh, *out.add_display());
  }
  if (geometry.skin) put(*geometry.skin, *out.mutable_skin());
  put(geometry.object, *out.mutable_object());
  out.set_rate_hz(static_cast<float>(geometry.rate_hz));
  for (int s = 0; s < kSegments; ++s) out.add_segment_name()->assign(segment_name(s));
  put_joints(geometry.hand, out);
}

}  // namespace phalanx
