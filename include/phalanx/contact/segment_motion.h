// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Motion of a segment's points as its digit's joints follow a straight line q(s) in joint space. It holds
/// exact first and second derivatives at one s, and bounds for the whole line, per unit of s, in W. With the
/// chain's axes z_j through c_j and their rates w_j, coupled ones among them, z_1 nearest to the palm:
///   velocity      v(x) = W x x + U,               W = sum w_j z_j,  U = -sum w_j z_j x c_j
///   acceleration  a(x) = W' x x + U' + W x v(x)   (W', U': each axis moves with the link that carries it)
struct SegmentMotion {
  Vec3 angular = Vec3::Zero();       ///< W [rad]
  Vec3 linear = Vec3::Zero();        ///< U, the velocity at the world's origin [m]
  Vec3 angular_rate = Vec3::Zero();  ///< W' [rad]
  Vec3 linear_rate = Vec3::Zero();   ///< U' [m]
  double speed = 0.0;                ///< |dx/ds| <= speed for every point of the segment [m]
  double bend = 0.0;                 ///< |d2x/ds2| <= bend for every point of the segment [m]
  double jerk = 0.0;                 ///< |d3x/ds3| <= jerk for every point of the segment [m]

  /// Returns the velocity v(x) of the point x [m per unit of s], in W. Real-time.
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept { return angular.cross(x) + linear; }
};

/// Returns the motion of the digit's segment k. Let R_j be the farthest that the segment reaches from axis
/// j, and V_j = |w_1| + .. + |w_j|. They bound the products of exponentials term by term:
///   |dx/ds| <= sum |w_j| R_j,   |d2x/ds2| <= sum (V_j^2 - V_(j-1)^2) R_j,
///   |d3x/ds3| <= sum (V_j^3 - V_(j-1)^3) R_j
/// @param pose  poses of the digit at this s
/// @param rate  of the joints, dq/ds [rad per unit of s]; coupled axes follow linearly
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] SegmentMotion segment_motion(const HandModel& hand, int digit, const DigitPose& pose,
                                           const DigitAngles& rate, int k) noexcept;

/// Segment k of a digit whose joints follow a straight line in joint space.
struct MovingSegment {
  int digit = 0;
  int k = 0;
  const DigitPose& pose;    ///< of the digit at this s
  const DigitAngles& rate;  ///< of its joints, dq/ds [rad per unit of s]
};
struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  ///< [m]
};

/// Returns the motion of a segment in another body's frame. The chain begins at that body, goes along its axes to the
/// palm, each with its rate reversed, and on along the axes of the segment; the formulas are those of segment_motion().
/// @param around   a sphere around the segment, in W [m]
/// @param frame    pose of the other body, in W
/// @param carrier  the other body, or null: it does not move
/// @param way      no point of the segment, and no axis of the carrier, moves farther along the line, both added [m]
/// Real-time: O(1), no allocation, lock, throw or I/O.
[[nodiscard]] SegmentMotion relative_motion(const HandModel& hand, const MovingSegment& segment,
                                            const Sphere& around, const Pose& frame,
                                            const MovingSegment* carrier, double way) noexcept;

/// Returns SegmentMotion::speed alone. Real-time.
[[nodiscard]] double segment_speed(const HandModel& hand, int digit, const DigitAngles& rate, int k) noexcept;

}  // namespace phalanx
