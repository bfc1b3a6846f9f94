// SPDX-License-Identifier: Apache-2.0
// The numbers of one hand as a hand file states them, always of a RIGHT hand. A left hand is its mirror
// image. S1 is a paper, listed in docs/architecture.md.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "phalanx/core/math.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// One row of a classic Denavit-Hartenberg table:  T = Rz(theta + q) Tz(d) Tx(a) Rx(alpha).        S1 sec. II
struct DhRow {
  double a = 0.0;      ///< link length [m]
  double alpha = 0.0;  ///< link twist [rad]
  double d = 0.0;      ///< link offset [m]
  double theta = 0.0;  ///< joint angle at q = 0 [rad]

  [[nodiscard]] bool operator==(const DhRow&) const = default;
};

/// Rotations of a digit's chain that no sensor measures and no motor drives: each is a linear function of the
/// digit's joint angles q [rad]. A coefficient of 0 leaves the rotation out.
struct DigitCoupling {
  /// Conjunct rotation of the first segment about its bone, after flexion and abduction:
  ///   pronation_per_flexion q_0 + pronation_per_abduction q_1.
  /// Positive pronates the thumb of a right hand: it turns the segment about the direction from tip to joint.
  double pronation_per_flexion = 0.0;    ///< [rad/rad]
  double pronation_per_abduction = 0.0;  ///< [rad/rad]
  /// Rotation of the whole digit with its metacarpal bone, before the first joint: metacarpal_per_flexion q_0.
  double metacarpal_per_flexion = 0.0;  ///< [rad/rad]

  [[nodiscard]] bool operator==(const DigitCoupling&) const = default;
};

/// Parameters of a digit's kinematic chain in the hand frame H, which is WebXR's `wrist`. Its origin is the
/// wrist's centre. Axis -Z points towards the middle finger's knuckle, +Y out of the back of the hand. Axis
/// +X points to the right of a right hand held palm down, which is the little finger's side.
struct DigitParameters {
  Vec3 base = Vec3::Zero();      ///< centre of the first joint, in H [m]
  Vec3 distal = -Vec3::UnitZ();  ///< direction of the straight digit at q = 0, in H [-]
  Vec3 dorsal = Vec3::UnitY();   ///< out of the digit's back at q = 0, in H [-]; made orthogonal to `distal`
  /// Joints in the order flexion, abduction, hinge, hinge. The last row's a is the distal bone's length.
  std::array<DhRow, kJointsPerDigit> dh;
  DigitCoupling coupling;
  /// Centre [m] and direction, in H, of the axis about which the coupling turns the metacarpal (right-handed).
  Vec3 metacarpal_base = Vec3::Zero();
  Vec3 metacarpal_axis = -Vec3::UnitX();

  [[nodiscard]] bool operator==(const DigitParameters&) const = default;
};

/// Tapered capsule along a segment's bone: spheres around the segment's joint and around the bone's far end.
struct SegmentShape {
  double length = 0.0;       ///< from the joint to the centre of the far sphere [m]
  double radius_base = 0.0;  ///< [m]
  double radius_tip = 0.0;   ///< [m]

  [[nodiscard]] bool operator==(const SegmentShape&) const = default;
};

/// Rounded slab of the palm, between an elliptic section at the wrist and one at the knuckles [m]. Breadths
/// and thicknesses are full, not half.
struct PalmShape {
  double length = 0.0;
  double wrist_breadth = 0.0;
  double wrist_thickness = 0.0;
  double knuckle_breadth = 0.0;
  double knuckle_thickness = 0.0;
  Vec3 offset = Vec3::Zero();  ///< centre of the wrist section in H [m]

  [[nodiscard]] bool operator==(const PalmShape&) const = default;
};

/// Numbers of one right hand.
struct HandParameters {
  std::string name;
  std::array<DigitParameters, kDigits> digits;
  std::array<SegmentShape, kSegments - 1> segments;
  PalmShape palm;
  JointArray min_angle{};   ///< range of motion [rad]
  JointArray max_angle{};   ///< range of motion [rad]
  JointArray open_angle{};  ///< the open hand, where the shown hand starts [rad]
  /// Where a scripted motion of closure 1 takes a joint [rad]; its largest angle if left out. A thumb opposes
  /// with an abduction of its own.
  std::array<std::optional<double>, kJoints> closed_angle{};

  [[nodiscard]] bool operator==(const HandParameters&) const = default;
};

/// Returns a hand of round numbers, for examples and programs without a hand file. It is 180 mm long, with five
/// equal straight digits along -Z. The knuckles are 20 mm apart, and 90 mm from the wrist. Set-up only.
[[nodiscard]] HandParameters straight_hand();

}  // namespace phalanx
