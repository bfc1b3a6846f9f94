// SPDX-License-Identifier: Apache-2.0
// The constant hand: chains of Denavit-Hartenberg (D-H) joints, and one closed triangle mesh per segment.
//
// The folder `hand` turns joint angles into poses of segments:
// 1. joints.h numbers and names the 20 joints and 16 segments.
// 2. hand_parameters.h holds the numbers of one hand, always of a right one; fit.h scales them to a patient.
// 3. HandModel (below) computes forward kinematics and Jacobians in the loop.
// 4. hand_skin.h holds the skin, which is for display only.
// S1 and S2 are the papers listed in docs/architecture.md.
#pragma once

#include <array>

#include "phalanx/core/math.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// Meshes of all segments, each in its segment's frame S [m]. S is WebXR's: origin at the segment's joint, -Z
/// along the bone towards the tip, +Y out of the back of the hand.
using SegmentMeshes = std::array<TriangleMesh, kSegments>;

/// An axis of a digit's chain at one pose, in world W: a point on it [m], and the unit vector along it. A
/// positive angle turns about this vector (right-handed).
struct JointAxis {
  Vec3 axis = Vec3::UnitX();
  Vec3 centre = Vec3::Zero();
};

/// Velocity of a chain's axes for given velocities of the digit's joints, or the axes' angles for given angles:
///   axis velocity = C joint velocity,  C constant
/// Entries of C other than 0 and 1 are the coupling's coefficients.
using AxisAngles = std::array<double, kAxesPerDigit>;
/// Returns C q. Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] constexpr AxisAngles axis_angles(const DigitCoupling& coupling, const DigitAngles& q) noexcept {
  return {coupling.metacarpal_per_flexion * q[0],
          q[0],
          q[1],
          coupling.pronation_per_flexion * q[0] + coupling.pronation_per_abduction * q[1],
          q[2],
          q[3]};
}

/// Poses of a digit's three segments and of its chain's axes at one set of angles, in world W.
struct DigitPose {
  std::array<Pose, kSegmentsPerDigit> segment;  ///< X_WS
  std::array<JointAxis, kAxesPerDigit> axis;    ///< in the order of joints.h; a coupled one if it turns
  DigitCoupling coupling;                       ///< the hand's, constant
};

/// Poses of all digits at one set of angles, in world W. The palm is fixed: HandModel::palm_pose().
struct HandPoses {
  std::array<DigitPose, kDigits> digit;
};

/// Kinematics and meshes of one hand, right or left, at a fixed place in the world. Constant.
class HandModel {
 public:
  /// @param parameters  a right hand's numbers; `handedness` mirrors them in H's x = 0 plane
  /// @param X_WH        pose of the hand frame (the wrist) in the world; fixed
  /// @param meshes      in the segments' frames, already of the right handedness
  /// @throws std::invalid_argument if a number is not finite, a limit or a mesh is empty, a coupling's ratio is
  /// beyond -1 .. 1, or a metacarpal's axis has no direction.
  HandModel(HandParameters parameters, Handedness handedness, const Pose& X_WH, SegmentMeshes meshes);

  [[nodiscard]] const HandParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] Handedness handedness() const noexcept { return handedness_; }
  /// Returns the mesh of a segment, in its frame S [m]. Real-time.
  /// @pre 0 <= segment < kSegments
  [[nodiscard]] const TriangleMesh& mesh(int segment) const noexcept {
    return meshes_[static_cast<std::size_t>(segment)];
  }
  /// Returns the meshes of all segments, in the segments' frames.
  [[nodiscard]] const SegmentMeshes& meshes() const noexcept { return meshes_; }
  [[nodiscard]] int triangle_count() const noexcept;

  /// Returns the pose X_WS of the palm, which does not move.
  [[nodiscard]] const Pose& palm_pose() const noexcept { return X_WH_; }

  /// Computes the forward kinematics of one digit as the product of its D-H transforms, with the coupled
  /// rotations between them.                                                                      S1 sec. II
  /// @param angle  the digit's joint angles, finite [rad]
  /// @pre 0 <= digit < kDigits
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  void digit_pose(int digit, const DigitAngles& angle, DigitPose& pose) const noexcept;

  /// Computes the poses of all five digits. Real-time.
  void poses(const JointArray& angle, HandPoses& poses) const noexcept;

  /// Returns the digit's coupled rotations. Real-time.
  /// @pre 0 <= digit < kDigits
  [[nodiscard]] const DigitCoupling& coupling(int digit) const noexcept {
    return parameters_.digits[static_cast<std::size_t>(digit)].coupling;
  }

  /// Returns an upper bound [m] on the distance of the digit's segment k from an axis of its chain. It holds
  /// for each point of the segment and at all angles. Real-time.
  /// @pre the axis moves segment k
  [[nodiscard]] double reach(int digit, int axis, int k) const noexcept {
    return reach_[static_cast<std::size_t>(digit)][static_cast<std::size_t>(axis)]
                 [static_cast<std::size_t>(k)];
  }

 private:
  void set_reach(int digit, int k);

  HandParameters parameters_;
  Handedness handedness_;
  Pose X_WH_;
  SegmentMeshes meshes_;
  /// D-H row of a joint, with the cosine and sine of its twist precomputed.
  struct ChainJoint {
    double a = 0.0;
    double d = 0.0;
    double theta = 0.0;
    double cos_alpha = 1.0;
    double sin_alpha = 0.0;
  };

  /// Frame of each digit's first joint at angle 0, in W: x distal, z the flexion axis. For a left hand it is
  /// the right hand's frame reflected in H's plane x = 0, and thus left-handed.
  std::array<Pose, kDigits> X_WB_;
  std::array<std::array<ChainJoint, kJointsPerDigit>, kDigits> joint_{};
  std::array<JointAxis, kDigits> metacarpal_axis_;  ///< in W
  std::array<std::array<std::array<double, kSegmentsPerDigit>, kAxesPerDigit>, kDigits> reach_{};
};

/// Columns of the geometric Jacobian of a point fixed to a digit's segment:  v = sum_i column_i dq_i/dt.
/// Columns of joints that do not move the segment are zero. A coupled axis adds its column to those of the
/// joints that drive it, times the coupling's coefficient.
struct PointJacobian {
  std::array<Vec3, kJointsPerDigit> linear;   ///< sum of axis x (p - centre) [m]
  std::array<Vec3, kJointsPerDigit> angular;  ///< sum of axis [-]
};
/// Returns the Jacobian at the point p_W [m] of the digit's segment k. Real-time: O(1), no allocation.
[[nodiscard]] PointJacobian point_jacobian(const DigitPose& pose, int k, const Vec3& p_W) noexcept;

/// Adds the torques of one force f_W [N], acting at p_W [m] on the digit's segment k, to `torque` [Nm]:
///   tau_i = J_i . f,  without coupling  axis_i . ((p - centre_i) x f)
/// For the force of a contact these are its torques on the finger. S1 eq. (3)-(5) print their negative, which
/// balances the contact. With coupling they are the torques of virtual work: a joint also feels what the axes
/// that it drives feel. Real-time: O(1), no allocation, lock, throw or I/O.
void add_torques(const DigitPose& pose, int digit, int k, const Vec3& p_W, const Vec3& f_W,
                 JointArray& torque) noexcept;

/// Adds the torques of a couple m_W [Nm] on the digit's segment k: tau_i = sum of axis . m, coupled axes among
/// them, as add_torques() does for a force. Real-time: O(1), no allocation, lock, throw or I/O.
void add_couple(const DigitPose& pose, int digit, int k, const Vec3& m_W, JointArray& torque) noexcept;

/// Returns tapered capsules for the digits and a rounded slab for the palm, from the lengths and breadths in
/// `parameters`. The whole hand has about `triangles` triangles. Set-up only.
/// @throws std::invalid_argument if `triangles` is below 800 or above 2,000,000
[[nodiscard]] SegmentMeshes make_capsule_meshes(const HandParameters& parameters, Handedness handedness,
                                                int triangles);

/// Returns the hand with capsule meshes, for a program without mesh files. Set-up only.
/// @throws as make_capsule_meshes() and HandModel
[[nodiscard]] HandModel make_hand_model(const HandParameters& parameters, Handedness handedness,
                                        const Pose& X_WH, int triangles);

}  // namespace phalanx
