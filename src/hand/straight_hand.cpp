// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include "phalanx/core/index.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

HandParameters straight_hand() {
  HandParameters hand;
  hand.name = "straight";
  constexpr double kQuarterTurn = std::numbers::pi / 2.0;
  for (int d = 0; d < kDigits; ++d) {
    DigitParameters& digit = hand.digits[idx(d)];
    digit.base = Vec3(0.02 * (d - 2), 0.0, -0.09);
    digit.dh[0].alpha = kQuarterTurn;
    digit.dh[1] = {.a = 0.040, .alpha = -kQuarterTurn};
    digit.dh[2].a = 0.025;
    digit.dh[3].a = 0.020;
    hand.segments[idx(segment_index(d, 0))] = {.length = 0.040, .radius_base = 0.008, .radius_tip = 0.007};
    hand.segments[idx(segment_index(d, 1))] = {.length = 0.025, .radius_base = 0.007, .radius_tip = 0.006};
    hand.segments[idx(segment_index(d, 2))] = {.length = 0.020, .radius_base = 0.006, .radius_tip = 0.005};
    for (int i = 0; i < kJointsPerDigit; ++i) {
      hand.min_angle[idx(joint_index(d, i))] = i == kAbductionJoint ? -0.3 : -0.5;
      hand.max_angle[idx(joint_index(d, i))] = i == kAbductionJoint ? 0.3 : 1.5;
    }
  }
  hand.palm = {.length = 0.08,
               .wrist_breadth = 0.06,
               .wrist_thickness = 0.03,
               .knuckle_breadth = 0.08,
               .knuckle_thickness = 0.025};
  return hand;
}

}  // namespace phalanx
