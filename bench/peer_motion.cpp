// SPDX-License-Identifier: Apache-2.0
#include "peer_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phalanx::bench {

SegmentField field_of(const HandModel& hand, int digit, int k, const DigitPose& pose,
                      const DigitAngles& rate) {
  SegmentField field;
  const int joints = joints_that_move(k);
  for (int j = 0; j < joints; ++j) {
    const double w = std::abs(rate[idx(j)]);
    const double reach = hand.reach(digit, j, k);
    double nearer = 0.0;
    double from_here = 0.0;
    for (int i = 0; i < joints; ++i) {
      const double w_i = std::abs(rate[idx(i)]);
      if (i < j) {
        nearer += w_i;
      } else {
        from_here += w_i * hand.reach(digit, i, k);
      }
    }
    const JointAxis& joint = pose.joint[idx(j)];
    field.angular += rate[idx(j)] * joint.axis;
    field.linear -= rate[idx(j)] * joint.axis.cross(joint.centre);
    field.speed += w * reach;
    field.acceleration += w * (2.0 * reach * nearer + from_here);
  }
  return field;
}

double travel(const HandModel& hand, int digit, int k, const DigitAngles& a, const DigitAngles& b) {
  double sum = 0.0;
  for (int j = 0; j < joints_that_move(k); ++j) {
    sum += std::abs(b[idx(j)] - a[idx(j)]) * hand.reach(digit, j, k);
  }
  return sum;
}

double safe_step(double height, double v, double A, double floor) {
  const double room = std::max(0.0, height - floor);
  const double root = std::sqrt(v * v + 2.0 * A * room);
  if (v > 0.0) return 2.0 * room / (v + root);
  return A > 0.0 ? (root - v) / A : std::numeric_limits<double>::infinity();
}

}  // namespace phalanx::bench
