// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Returns the right-handed frame of a digit's first joint at q = 0, in H: x distal, z the flexion axis.
Pose base_frame(const DigitParameters& digit) {
  const Vec3 x = digit.distal.normalized();
  const Vec3 z = digit.dorsal.cross(x).normalized();
  Pose pose;
  pose.R.col(0) = x;
  pose.R.col(1) = z.cross(x);
  pose.R.col(2) = z;
  pose.p = digit.base;
  return pose;
}

void check_coupling(const DigitParameters& digit, const std::string& name) {
  const DigitCoupling& coupling = digit.coupling;
  for (const double ratio :
       {coupling.pronation_per_flexion, coupling.pronation_per_abduction, coupling.metacarpal_per_flexion}) {
    if (!(std::abs(ratio) <= 1.0)) {
      throw std::invalid_argument(name + ": a coupled rotation has the ratio " + std::to_string(ratio) +
                                  "; it must be in -1 .. 1");
    }
  }
  const double length = digit.metacarpal_axis.norm();
  if (!(length > 1e-6 && std::isfinite(length)))
    throw std::invalid_argument(name + ": its metacarpal's axis has no direction; give it one");
}

void check(const HandParameters& parameters, const SegmentMeshes& meshes) {
  const std::string name = "hand '" + parameters.name + "': ";
  for (int j = 0; j < kJoints; ++j) {
    const double low = parameters.min_angle[idx(j)];
    const double high = parameters.max_angle[idx(j)];
    const double open = parameters.open_angle[idx(j)];
    if (!(std::isfinite(low) && std::isfinite(high) && low < high)) {
      throw std::invalid_argument(name + "joint " + std::string(joint_name(j)) +
                                  " has an empty range of motion; its minimum must be below its maximum");
    }
    if (!(open >= low && open <= high)) {
      throw std::invalid_argument(name + "joint " + std::string(joint_name(j)) +
                                  " is open outside its range of motion; move the open angle inside");
    }
    const double closed = parameters.closed_angle[idx(j)].value_or(high);
    if (!(closed >= low && closed <= high)) {
      throw std::invalid_argument(name + "joint " + std::string(joint_name(j)) +
                                  " is closed outside its range of motion; move the closed angle inside");
    }
  }
  for (int d = 0; d < kDigits; ++d) {
    const DigitParameters& digit = parameters.digits[idx(d)];
    bool finite = digit.base.allFinite() && digit.distal.allFinite() && digit.dorsal.allFinite();
    for (const DhRow& row : digit.dh) {
      finite = finite && std::isfinite(row.a) && std::isfinite(row.alpha) && std::isfinite(row.d) &&
               std::isfinite(row.theta);
    }
    finite = finite && digit.metacarpal_base.allFinite();
    check_coupling(digit, name + "digit " + std::string(digit_name(d)));
    if (!finite || digit.distal.cross(digit.dorsal).norm() < 1e-6) {
      throw std::invalid_argument(
          name + "digit " + std::string(digit_name(d)) +
          " has a number that is not finite, or parallel distal and dorsal directions");
    }
  }
  for (int s = 0; s < kSegments; ++s) {
    check_mesh(meshes[idx(s)], (name + "segment " + std::string(segment_name(s))).c_str());
  }
}

bool turns_metacarpal(const DigitCoupling& coupling) noexcept {
  return coupling.metacarpal_per_flexion != 0.0;
}

bool pronates(const DigitCoupling& coupling) noexcept {
  return coupling.pronation_per_flexion != 0.0 || coupling.pronation_per_abduction != 0.0;
}

/// Returns the reflection of vectors of H in its plane x = 0.
Mat3 reflection() { return Vec3(-1.0, 1.0, 1.0).asDiagonal(); }

}  // namespace

HandModel::HandModel(HandParameters parameters, Handedness handedness, const Pose& X_WH, SegmentMeshes meshes)
    : parameters_(std::move(parameters)), handedness_(handedness), X_WH_(X_WH), meshes_(std::move(meshes)) {
  check(parameters_, meshes_);
  const bool rigid = X_WH.p.allFinite() && X_WH.R.allFinite() &&
                     (X_WH.R.transpose() * X_WH.R - Mat3::Identity()).norm() < 1e-9 &&
                     X_WH.R.determinant() > 0.0;
  if (!rigid) {
    throw std::invalid_argument("hand '" + parameters_.name +
                                "': its pose in the world is not a finite rotation and translation");
  }
  const bool mirrored = handedness == Handedness::kLeft;
  for (int d = 0; d < kDigits; ++d) {
    const DigitParameters& digit = parameters_.digits[idx(d)];
    X_WB_[idx(d)] = X_WH * (mirrored ? Pose{reflection()} * base_frame(digit) : base_frame(digit));
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const DhRow& row = digit.dh[idx(i)];
      joint_[idx(d)][idx(i)] = {row.a, row.d, row.theta, std::cos(row.alpha), std::sin(row.alpha)};
    }
    const Vec3 axis_H = digit.metacarpal_axis.normalized();
    // An axis is a pseudovector: a reflection keeps its component across the plane and turns the others round.
    metacarpal_axis_[idx(d)] = {
        X_WH.R * (mirrored ? Vec3(-(reflection() * axis_H)) : axis_H),
        X_WH * (mirrored ? Vec3(reflection() * digit.metacarpal_base) : digit.metacarpal_base)};
    for (int k = 0; k < kSegmentsPerDigit; ++k) set_reach(d, k);
  }
}

void HandModel::set_reach(int d, int k) {
  const DigitParameters& digit = parameters_.digits[idx(d)];
  double radius = 0.0;  // of the segment's vertices around its origin [m]
  double beside = 0.0;  // and around its bone
  for (const Vec3& v : mesh(segment_index(d, k)).vertices) {
    radius = std::max(radius, v.norm());
    beside = std::max(beside, std::hypot(v.x(), v.y()));
  }
  const auto reach = [&](int axis) -> double& { return reach_[idx(d)][idx(axis)][idx(k)]; };
  // The segment's origin is at this distance along the axis from the joint's centre.
  radius += std::abs(digit.dh[idx(k + 1)].d);
  // Distances between successive D-H origins do not depend on the angles. Joint k + 1 is the segment's own.
  for (int i = k + 1; i >= 0; --i) {
    reach(axis_of_joint(i)) = radius;
    if (i > 0) radius += std::hypot(digit.dh[idx(i - 1)].a, digit.dh[idx(i - 1)].d);
  }
  // The axis of pronation is the first segment's bone and passes through the centre of the next joint.
  reach(kPronationAxis) = k == 0 ? beside : reach(axis_of_joint(2));
  reach(kMetacarpalAxis) = reach(axis_of_joint(0)) + (digit.base - digit.metacarpal_base).norm();
}

int HandModel::triangle_count() const noexcept {
  std::size_t count = 0;
  for (const TriangleMesh& mesh : meshes_) count += mesh.triangles.size();
  return static_cast<int>(count);
}

void HandModel::digit_pose(int digit, const DigitAngles& angle, DigitPose& pose) const noexcept {
  // This is the right hand's chain. For a left hand the base is reflected, so that the chain carries
  // reflected frames. In these the third axis is the negative of the flexion axis, because an axis
  // is a pseudovector.
  const double flexion = handedness_ == Handedness::kLeft ? -1.0 : 1.0;
  const Pose& base = X_WB_[idx(digit)];
  Vec3 x = base.R.col(0);
  Vec3 y = base.R.col(1);
  Vec3 z = base.R.col(2);
  Vec3 p = base.p;
  pose.coupling = coupling(digit);
  const AxisAngles turn = axis_angles(pose.coupling, angle);
  if (turns_metacarpal(pose.coupling)) {
    const JointAxis& metacarpal = metacarpal_axis_[idx(digit)];
    pose.axis[kMetacarpalAxis] = metacarpal;
    const Mat3 R = rotation_about(metacarpal.axis, turn[kMetacarpalAxis]);
    x = R * x;
    y = R * y;
    z = R * z;
    p = metacarpal.centre + R * (p - metacarpal.centre);
  }
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const ChainJoint& joint = joint_[idx(digit)][idx(i)];
    const double c = std::cos(joint.theta + angle[idx(i)]);
    const double s = std::sin(joint.theta + angle[idx(i)]);
    const Vec3 axis = flexion * z;
    pose.axis[idx(axis_of_joint(i))] = {axis, p};
    // Rz(theta + q) Tz(d): `across` is normal to the link and to z.
    const Vec3 link = c * x + s * y;
    const Vec3 across = c * y - s * x;
    const Vec3 start = p + joint.d * z;
    // Tx(a) Rx(alpha).
    p = start + joint.a * link;
    x = link;
    y = joint.cos_alpha * across + joint.sin_alpha * z;
    z = joint.cos_alpha * z - joint.sin_alpha * across;
    if (i == 0) continue;
    if (i == kAbductionJoint && pronates(pose.coupling)) {
      pose.axis[kPronationAxis] = {-flexion * x, start};
      const double cp = std::cos(turn[kPronationAxis]);
      const double sp = std::sin(turn[kPronationAxis]);
      const Vec3 side = y;
      y = cp * side - sp * z;
      z = cp * z + sp * side;
    }
    // The frame at the link's far end is turned into WebXR's: origin at the joint, -Z along the link, -X
    // along the flexion axis.
    Pose& segment = pose.segment[idx(i - 1)];
    segment.R.col(0) = -flexion * z;
    segment.R.col(1) = -y;
    segment.R.col(2) = -x;
    segment.p = start;
  }
}

void HandModel::poses(const JointArray& angle, HandPoses& poses) const noexcept {
  for (int d = 0; d < kDigits; ++d) digit_pose(d, digit_angles(angle, d), poses.digit[idx(d)]);
}

PointJacobian point_jacobian(const DigitPose& pose, int k, const Vec3& p_W) noexcept {
  const DigitCoupling& coupling = pose.coupling;
  PointJacobian J;
  J.linear.fill(Vec3::Zero());
  J.angular.fill(Vec3::Zero());
  const auto add = [&](int joint, double coefficient, const JointAxis& axis) {
    J.linear[idx(joint)] += coefficient * axis.axis.cross(p_W - axis.centre);
    J.angular[idx(joint)] += coefficient * axis.axis;
  };
  for (int i = 0; i < joints_that_move(k); ++i) add(i, 1.0, pose.axis[idx(axis_of_joint(i))]);
  if (turns_metacarpal(coupling)) add(0, coupling.metacarpal_per_flexion, pose.axis[kMetacarpalAxis]);
  if (!pronates(coupling)) return J;
  add(0, coupling.pronation_per_flexion, pose.axis[kPronationAxis]);
  add(kAbductionJoint, coupling.pronation_per_abduction, pose.axis[kPronationAxis]);
  return J;
}

namespace {

/// Adds the torques of a load whose virtual work per axis is about(axis).
template <class About>
void add_work(const DigitPose& pose, int digit, int k, About&& about, JointArray& torque) noexcept {
  for (int i = 0; i < joints_that_move(k); ++i) torque[idx(joint_index(digit, i))] += about(axis_of_joint(i));
  const DigitCoupling& coupling = pose.coupling;
  if (turns_metacarpal(coupling))
    torque[idx(joint_index(digit, 0))] += coupling.metacarpal_per_flexion * about(kMetacarpalAxis);
  if (!pronates(coupling)) return;
  const double pronation = about(kPronationAxis);
  torque[idx(joint_index(digit, 0))] += coupling.pronation_per_flexion * pronation;
  torque[idx(joint_index(digit, kAbductionJoint))] += coupling.pronation_per_abduction * pronation;
}

}  // namespace

void add_torques(const DigitPose& pose, int digit, int k, const Vec3& p_W, const Vec3& f_W,
                 JointArray& torque) noexcept {
  add_work(
      pose, digit, k,
      [&](int axis) {
        const JointAxis& a = pose.axis[idx(axis)];
        return a.axis.dot((p_W - a.centre).cross(f_W));
      },
      torque);
}

void add_couple(const DigitPose& pose, int digit, int k, const Vec3& m_W, JointArray& torque) noexcept {
  add_work(pose, digit, k, [&](int axis) { return pose.axis[idx(axis)].axis.dot(m_W); }, torque);
}

}  // namespace phalanx
