// SPDX-License-Identifier: Apache-2.0
// The constant hand: chains of Denavit-Hartenberg joints, and one closed triangle mesh per segment.
#pragma once

#include <array>

#include "phalanx/core/math.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx {

/// One mesh per segment, each in its segment's frame S: WebXR's, origin at the segment's joint, -Z along the
/// bone towards the tip, +Y out of the back [m].
using SegmentMeshes = std::array<TriangleMesh, kSegments>;

/// A joint of a digit at one pose, in world W: its axis (unit, the direction about which a positive angle
/// turns) and a point on it [m].
struct JointAxis {
  Vec3 axis = Vec3::UnitX();
  Vec3 centre = Vec3::Zero();
};

/// A digit at one pose, in world W: where its three segments are and where its four joints turn.
struct DigitPose {
  std::array<Pose, kSegmentsPerDigit> segment;  ///< X_WS
  std::array<JointAxis, kJointsPerDigit> joint;
};

/// Angles of one digit's joints [rad].
using DigitAngles = std::array<double, kJointsPerDigit>;

/// The hand at one set of angles.
struct HandPoses {
  std::array<DigitPose, kDigits> digit;
};

class HandModel {
 public:
  /// @param parameters  a right hand's numbers; `handedness` mirrors them in H's x = 0 plane
  /// @param X_WH        pose of the hand frame (the wrist) in the world; fixed
  /// @param meshes      in the segments' frames, already of the right handedness
  /// @throws std::invalid_argument if a number is not finite, a limit is empty, or a mesh is empty.
  HandModel(HandParameters parameters, Handedness handedness, const Pose& X_WH, SegmentMeshes meshes);

  [[nodiscard]] const HandParameters& parameters() const noexcept { return parameters_; }
  [[nodiscard]] Handedness handedness() const noexcept { return handedness_; }
  [[nodiscard]] const TriangleMesh& mesh(int segment) const noexcept {
    return meshes_[static_cast<std::size_t>(segment)];
  }
  /// All of them, in the segments' frames.
  [[nodiscard]] const SegmentMeshes& meshes() const noexcept { return meshes_; }
  [[nodiscard]] int triangle_count() const noexcept;

  /// Pose of the palm, X_WS; it does not move.
  [[nodiscard]] const Pose& palm_pose() const noexcept { return X_WH_; }

  /// Forward kinematics of one digit: the product of its D-H transforms. Real-time: no allocation, lock,
  /// throw or I/O.   S1 sec. II
  void digit_pose(int digit, const DigitAngles& angle, DigitPose& pose) const noexcept;

  /// All five digits. Real-time.
  void poses(const JointArray& angle, HandPoses& poses) const noexcept;

  /// Largest distance of any point of the digit's segment k from the centre of the digit's joint i, at any
  /// angles [m]; i must move k.
  [[nodiscard]] double reach(int digit, int joint, int k) const noexcept {
    return reach_[static_cast<std::size_t>(digit)][static_cast<std::size_t>(joint)]
                 [static_cast<std::size_t>(k)];
  }

 private:
  HandParameters parameters_;
  Handedness handedness_;
  Pose X_WH_;
  SegmentMeshes meshes_;
  /// A D-H row, with what does not depend on the angle worked out.
  struct ChainJoint {
    double a = 0.0;
    double d = 0.0;
    double theta = 0.0;
    double cos_alpha = 1.0;
    double sin_alpha = 0.0;
  };

  /// In W, each digit's first joint before it turns: x distal, z flexion axis. A right hand's frame; of a
  /// left hand, that frame's reflection in H's x = 0 plane, which is left-handed.
  std::array<Pose, kDigits> X_WB_;
  std::array<std::array<ChainJoint, kJointsPerDigit>, kDigits> joint_{};
  std::array<std::array<std::array<double, kSegmentsPerDigit>, kJointsPerDigit>, kDigits> reach_{};
};

/// The angles of one digit out of the whole hand's. Real-time.
[[nodiscard]] DigitAngles digit_angles(const JointArray& angle, int digit) noexcept;

/// Columns of the geometric Jacobian of the point p_W fixed to the digit's segment k:  v = sum_i column_i
/// dq_i/dt. Columns of joints that do not move the segment are zero. Real-time.
struct PointJacobian {
  std::array<Vec3, kJointsPerDigit> linear;   ///< axis x (p - centre) [m]
  std::array<Vec3, kJointsPerDigit> angular;  ///< axis [-]
};
[[nodiscard]] PointJacobian point_jacobian(const DigitPose& pose, int k, const Vec3& p_W) noexcept;

/// Tapered capsules and a rounded slab from the lengths and breadths in `parameters`, about `triangles` over
/// the whole hand.
/// @throws std::invalid_argument if `triangles` is below 800 or above 2,000,000.
[[nodiscard]] SegmentMeshes make_capsule_meshes(const HandParameters& parameters, Handedness handedness,
                                                int triangles);

/// The hand with capsule meshes.
[[nodiscard]] HandModel make_hand_model(const HandParameters& parameters, Handedness handedness,
                                        const Pose& X_WH, int triangles);

}  // namespace phalanx
