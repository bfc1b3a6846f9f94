// SPDX-License-Identifier: Apache-2.0
#include "record/export/segment_wrench.h"

#include "phalanx/core/index.h"

namespace phalanx {

std::optional<SegmentPoses> shown_poses(const wire::Tick& tick) {
  constexpr int kNumbers = 7;  // position x y z, quaternion x y z w
  if (tick.gdp_pose_size() != kNumbers * kSegments) return std::nullopt;
  SegmentPoses X_WS;
  for (int s = 0; s < kSegments; ++s) {
    const auto number = [&](int i) { return static_cast<double>(tick.gdp_pose(kNumbers * s + i)); };
    const Eigen::Quaterniond q(number(6), number(3), number(4), number(5));
    X_WS[idx(s)].p = Vec3(number(0), number(1), number(2));
    X_WS[idx(s)].R = q.normalized().toRotationMatrix();
  }
  return X_WS;
}

namespace {

/// @param numbers  three, as a message of cockpit.proto has them
Vec3 vector3(const google::protobuf::RepeatedField<float>& numbers) {
  return {static_cast<double>(numbers.Get(0)), static_cast<double>(numbers.Get(1)),
          static_cast<double>(numbers.Get(2))};
}

}  // namespace

SegmentWrenches segment_wrenches(const wire::Tick& tick, const SegmentPoses& X_WS) {
  SegmentWrenches wrenches;
  for (const wire::Contact& contact : tick.contact()) {
    if (contact.segment() >= kSegments || contact.normal_size() != 3 || contact.point_size() != 3) continue;
    const Vec3 normal = vector3(contact.normal());
    const Vec3 point = vector3(contact.point());
    SegmentWrench& wrench = wrenches[contact.segment()];
    const Vec3 force = static_cast<double>(tick.factor()) * static_cast<double>(contact.force()) * normal;
    wrench.force += force;
    wrench.moment += (point - X_WS[contact.segment()].p).cross(force);
  }
  return wrenches;
}

}  // namespace phalanx
