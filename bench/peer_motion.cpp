// SPDX-License-Identifier: Apache-2.0
#include "peer_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phalanx::bench {

SegmentField field_of(const HandModel& hand, int digit, int k, const DigitPose& pose,
                      const DigitAngles& rate) {
  SegmentField field;
  const AxisAngles rates = axis_angles(hand.coupling(digit), rate);
  const int axes = axes_that_move(k);
  for (int j = 0; j < axes; ++j) {
    const double w = std::abs(rates[idx(j)]);
    const double reach = hand.reach(digit, j, k);
    double nearer = 0.0;
    double from_here = 0.0;
    for (int i = 0; i < axes; ++i) {
      const double w_i = std::abs(rates[idx(i)]);
      if (i < j) {
        nearer += w_i;
      } else {
        from_here += w_i * hand.reach(digit, i, k);
      }
    }
    const JointAxis& joint = pose.axis[idx(j)];
    field.angular += rates[idx(j)] * joint.axis;
    field.linear -= rates[idx(j)] * joint.axis.cross(joint.centre);
    field.speed += w * reach;
    field.acceleration += w * (2.0 * reach * nearer + from_here);
  }
  return field;
}

double travel(const HandModel& hand, int digit, int k, const DigitAngles& a, const DigitAngles& b) {
  DigitAngles way{};
  for (int i = 0; i < kJointsPerDigit; ++i) way[idx(i)] = b[idx(i)] - a[idx(i)];
  const AxisAngles turned = axis_angles(hand.coupling(digit), way);
  double sum = 0.0;
  for (int j = 0; j < axes_that_move(k); ++j) sum += std::abs(turned[idx(j)]) * hand.reach(digit, j, k);
  return sum;
}

double safe_step(double height, double v, double A, double floor) {
  const double room = std::max(0.0, height - floor);
  const double root = std::sqrt(v * v + 2.0 * A * room);
  if (v > 0.0) return 2.0 * room / (v + root);
  return A > 0.0 ? (root - v) / A : std::numeric_limits<double>::infinity();
}

}  // namespace phalanx::bench
