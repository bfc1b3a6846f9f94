// SPDX-License-Identifier: Apache-2.0
#include "record/recording/foxglove_message.h"

#include "phalanx/core/index.h"
#include "phalanx/hand/joints.h"
#include "phalanx/station/session.h"

namespace phalanx {
namespace {

constexpr const char* kWorld = "world";
constexpr double kMetresPerNewton = 0.01;
constexpr double kLeastForce = 0.01;  ///< that has an arrow [N]

struct Rgba {
  double r, g, b, a;
};
constexpr Rgba kObject = {0.55, 0.60, 0.68, 1.0};
constexpr Rgba kHand = {0.86, 0.69, 0.58, 1.0};
constexpr Rgba kForce = {0.90, 0.30, 0.15, 1.0};

void put(const Vec3& v, foxglove::Vector3& out) {
  out.set_x(v.x());
  out.set_y(v.y());
  out.set_z(v.z());
}

void put(const Eigen::Quaterniond& q, foxglove::Quaternion& out) {
  out.set_x(q.x());
  out.set_y(q.y());
  out.set_z(q.z());
  out.set_w(q.w());
}

void put(const Rgba& colour, foxglove::Color& out) {
  out.set_r(colour.r);
  out.set_g(colour.g);
  out.set_b(colour.b);
  out.set_a(colour.a);
}

void put(std::uint64_t time, google::protobuf::Timestamp& out) {
  constexpr std::uint64_t kSecond = 1'000'000'000;  // [ns]
  out.set_seconds(static_cast<std::int64_t>(time / kSecond));
  out.set_nanos(static_cast<std::int32_t>(time % kSecond));
}

foxglove::SceneEntity& begin_entity(const std::string& id, const std::string& frame, std::uint64_t time,
                                    foxglove::SceneUpdate& out) {
  foxglove::SceneEntity& entity = *out.add_entities();
  put(time, *entity.mutable_timestamp());
  entity.set_frame_id(frame);
  entity.set_id(id);
  entity.set_frame_locked(true);
  return entity;
}

void put(const TriangleMesh& mesh, const Rgba& colour, foxglove::SceneEntity& out) {
  if (mesh.triangles.empty()) return;
  foxglove::TriangleListPrimitive& triangles = *out.add_triangles();
  triangles.mutable_pose()->mutable_orientation()->set_w(1.0);
  put(colour, *triangles.mutable_color());
  triangles.mutable_points()->Reserve(static_cast<int>(mesh.vertices.size()));
  for (const Vec3& v : mesh.vertices) {
    foxglove::Point3& point = *triangles.add_points();
    point.set_x(v.x());
    point.set_y(v.y());
    point.set_z(v.z());
  }
  triangles.mutable_indices()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles)
    for (const std::int32_t i : triangle) triangles.add_indices(static_cast<std::uint32_t>(i));
}

}  // namespace

void write_frames(const StationView& view, std::uint64_t time, foxglove::FrameTransforms& out) {
  out.Clear();
  for (int s = 0; s < kSegments; ++s) {
    const Pose& X = view.snapshot.gdp_pose[idx(s)];
    foxglove::FrameTransform& frame = *out.add_transforms();
    put(time, *frame.mutable_timestamp());
    frame.set_parent_frame_id(kWorld);
    frame.set_child_frame_id(std::string(segment_name(s)));
    put(X.p, *frame.mutable_translation());
    put(Eigen::Quaterniond(X.R), *frame.mutable_rotation());
  }
}

void write_meshes(const SessionGeometry& geometry, std::uint64_t time, foxglove::SceneUpdate& out) {
  out.Clear();
  put(geometry.object, kObject, begin_entity("object", kWorld, time, out));
  for (int s = 0; s < kSegments; ++s) {
    const std::string name(segment_name(s));
    put(geometry.display[idx(s)], kHand, begin_entity(name, name, time, out));
  }
}

int write_forces(const StationView& view, std::uint64_t time, foxglove::SceneUpdate& out) {
  out.Clear();
  foxglove::SceneEntity& entity = begin_entity("forces", kWorld, time, out);
  for (const SegmentSnapshot& segment : view.snapshot.segment) {
    const double force = view.factor * segment.force;
    if (force < kLeastForce) continue;
    foxglove::ArrowPrimitive& arrow = *entity.add_arrows();
    put(segment.point, *arrow.mutable_pose()->mutable_position());
    put(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), segment.normal),
        *arrow.mutable_pose()->mutable_orientation());
    arrow.set_shaft_length(kMetresPerNewton * force);
    arrow.set_shaft_diameter(0.003);
    arrow.set_head_length(0.005);
    arrow.set_head_diameter(0.007);
    put(kForce, *arrow.mutable_color());
  }
  return entity.arrows_size();
}

}  // namespace phalanx
