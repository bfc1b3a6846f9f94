// SPDX-License-Identifier: Apache-2.0
// The numbers of one hand, as a hand file states them. Always those of a RIGHT hand; a left hand is its
// mirror image.
#pragma once

#include <array>
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
};

/// A digit's chain. Hand frame H, WebXR's `wrist`: origin at the wrist's centre, -Z towards the middle
/// finger's knuckle, +Y out of the back of the hand, +X to the right of a right hand held palm down (the
/// little finger's side).
struct DigitParameters {
  Vec3 base = Vec3::Zero();      ///< centre of the first joint, in H [m]
  Vec3 distal = -Vec3::UnitZ();  ///< direction of the straight digit at q = 0, in H [-]
  Vec3 dorsal = Vec3::UnitY();   ///< out of the digit's back at q = 0, in H [-]; made orthogonal to `distal`
  std::array<DhRow, kJointsPerDigit>
      dh;  ///< flexion, abduction, hinge, hinge; the last row's a is the bone's length
};

/// A tapered capsule along a segment's bone: spheres of these radii at the segment's joint and at the bone's
/// end.
struct SegmentShape {
  double length = 0.0;       ///< from the joint to the centre of the far sphere [m]
  double radius_base = 0.0;  ///< [m]
  double radius_tip = 0.0;   ///< [m]
};

/// The palm: a rounded slab between an elliptic section at the wrist and one at the knuckles (full breadths
/// and thicknesses) [m].
struct PalmShape {
  double length = 0.0;
  double wrist_breadth = 0.0;
  double wrist_thickness = 0.0;
  double knuckle_breadth = 0.0;
  double knuckle_thickness = 0.0;
  Vec3 offset = Vec3::Zero();  ///< centre of the wrist section in H [m]
};

struct HandParameters {
  std::string name;
  std::array<DigitParameters, kDigits> digits;
  std::array<SegmentShape, kSegments - 1> segments;
  PalmShape palm;
  JointArray min_angle{};   ///< range of motion [rad]
  JointArray max_angle{};   ///< range of motion [rad]
  JointArray open_angle{};  ///< the open hand, from which the GDP starts [rad]
};

}  // namespace phalanx
