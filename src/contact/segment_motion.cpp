// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/segment_motion.h"

#include <cmath>

#include "phalanx/core/index.h"

namespace phalanx {

double segment_speed(const HandModel& hand, int digit, const DigitAngles& rate, int k) noexcept {
  const AxisAngles w = axis_angles(hand.coupling(digit), rate);
  double speed = 0.0;
  for (int j = 0; j < axes_that_move(k); ++j) speed += std::abs(w[idx(j)]) * hand.reach(digit, j, k);
  return speed;
}

SegmentMotion segment_motion(const HandModel& hand, int digit, const DigitPose& pose, const DigitAngles& rate,
                             int k) noexcept {
  SegmentMotion motion;
  const AxisAngles rates = axis_angles(hand.coupling(digit), rate);
  double turned = 0.0;
  for (int j = 0; j < axes_that_move(k); ++j) {
    const double w = rates[idx(j)];
    if (w == 0.0) continue;
    const JointAxis& joint = pose.axis[idx(j)];
    const Vec3 moment = joint.centre.cross(joint.axis);
    // The links before this axis carry it; their motion has been summed so far.
    motion.angular_rate += w * motion.angular.cross(joint.axis);
    motion.linear_rate += w * (motion.angular.cross(moment) + motion.linear.cross(joint.axis));
    motion.angular += w * joint.axis;
    motion.linear += w * moment;

    const double reach = hand.reach(digit, j, k);
    const double turning = turned + std::abs(w);
    motion.speed += std::abs(w) * reach;
    motion.bend += (turning * turning - turned * turned) * reach;
    motion.jerk += (turning * turning * turning - turned * turned * turned) * reach;
    turned = turning;
  }
  return motion;
}

}  // namespace phalanx
