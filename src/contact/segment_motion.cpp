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

namespace {

/// Motion at the end of a chain of axes, which are added from the base outwards.
class Chain {
 public:
  /// @param axis   at this pose, in the frame of the motion
  /// @param rate   of the rotation about it [rad per unit of s]
  /// @param reach  farthest distance of the segment's points from it [m]
  void add(const JointAxis& axis, double rate, double reach) noexcept {
    if (rate == 0.0) return;
    const Vec3 moment = axis.centre.cross(axis.axis);
    // The axes before this one carry it; their motion has been summed so far.
    motion_.angular_rate += rate * motion_.angular.cross(axis.axis);
    motion_.linear_rate += rate * (motion_.angular.cross(moment) + motion_.linear.cross(axis.axis));
    motion_.angular += rate * axis.axis;
    motion_.linear += rate * moment;

    const double turning = turned_ + std::abs(rate);
    motion_.speed += std::abs(rate) * reach;
    motion_.bend += (turning * turning - turned_ * turned_) * reach;
    motion_.jerk += (turning * turning * turning - turned_ * turned_ * turned_) * reach;
    turned_ = turning;
  }
  [[nodiscard]] const SegmentMotion& motion() const noexcept { return motion_; }

 private:
  SegmentMotion motion_;
  double turned_ = 0.0;  ///< by all axes so far [rad per unit of s]
};

}  // namespace

SegmentMotion segment_motion(const HandModel& hand, int digit, const DigitPose& pose, const DigitAngles& rate,
                             int k) noexcept {
  Chain chain;
  const AxisAngles rates = axis_angles(hand.coupling(digit), rate);
  for (int j = 0; j < axes_that_move(k); ++j)
    chain.add(pose.axis[idx(j)], rates[idx(j)], hand.reach(digit, j, k));
  return chain.motion();
}

SegmentMotion relative_motion(const HandModel& hand, const MovingSegment& segment, const Sphere& around,
                              const Pose& frame, const MovingSegment* carrier, double way) noexcept {
  const auto in_frame = [&](const JointAxis& axis) {
    return JointAxis{frame.R.transpose() * axis.axis, frame.R.transpose() * (axis.centre - frame.p)};
  };
  Chain chain;
  if (carrier != nullptr) {
    const AxisAngles rates = axis_angles(hand.coupling(carrier->digit), carrier->rate);
    for (int j = axes_that_move(carrier->k) - 1; j >= 0; --j) {
      const JointAxis& axis = carrier->pose.axis[idx(j)];
      chain.add(in_frame(axis), -rates[idx(j)], (axis.centre - around.centre).norm() + around.radius + way);
    }
  }
  const AxisAngles rates = axis_angles(hand.coupling(segment.digit), segment.rate);
  for (int j = 0; j < axes_that_move(segment.k); ++j)
    chain.add(in_frame(segment.pose.axis[idx(j)]), rates[idx(j)], hand.reach(segment.digit, j, segment.k));
  return chain.motion();
}

}  // namespace phalanx
