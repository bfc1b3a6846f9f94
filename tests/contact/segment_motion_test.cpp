// SPDX-License-Identifier: Apache-2.0
// A segment's velocity and acceleration along a straight way in joint space against differences of the hand's
// poses, and the bounds on its speed, bend and jerk against what its points do all along the way.
#include "phalanx/contact/segment_motion.h"

#include <gmock/gmock.h>

#include <iostream>

#include "support/search_cases.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::between;
using test::Random;

/// A straight way of one digit of one hand, and a point of its segment k.
struct Way {
  const HandModel& hand;
  int digit;
  int k;
  DigitAngles angle;
  DigitAngles rate;
  Vec3 point;  ///< in the segment's frame

  [[nodiscard]] DigitPose pose(double s) const {
    DigitAngles q = angle;
    for (std::size_t i = 0; i < kJointsPerDigit; ++i) q[i] += s * rate[i];
    DigitPose out;
    hand.digit_pose(digit, q, out);
    return out;
  }
  [[nodiscard]] Vec3 place(double s) const { return pose(s).segment[static_cast<std::size_t>(k)] * point; }
  /// Sum of the rates of all axes.
  [[nodiscard]] double turned() const {
    double sum = 0.0;
    for (const double w : axis_angles(hand.coupling(digit), rate)) sum += std::abs(w);
    return sum;
  }
  [[nodiscard]] SegmentMotion motion(double s) const { return segment_motion(hand, digit, pose(s), rate, k); }
};

Way any_way(Random& random, const HandModel& hand) {
  const int digit = static_cast<int>(between(random, 0.0, 4.999));
  const int k = static_cast<int>(between(random, 0.0, 2.999));
  Way way{hand, digit, k, {}, {}, Vec3::Zero()};
  for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
    way.angle[i] = between(random, -1.0, 1.5);
    way.rate[i] = between(random, 0.0, 1.0) < 0.2 ? 0.0 : between(random, -1.5, 1.5);
  }
  const std::vector<Vec3>& vertices = hand.mesh(segment_index(digit, k)).vertices;
  way.point =
      vertices[static_cast<std::size_t>(between(random, 0.0, static_cast<double>(vertices.size()) - 0.001))];
  return way;
}

std::vector<HandModel> hands(Random& random) {
  std::vector<HandModel> out;
  for (const Handedness side : {Handedness::kRight, Handedness::kLeft}) {
    out.push_back(test::simple_hand(side, test::any_pose(random, 0.5), 800));
    HandParameters crooked = test::simple_parameters();
    for (DigitParameters& digit : crooked.digits) {
      for (DhRow& row : digit.dh) {
        row.alpha += between(random, -0.3, 0.3);
        row.d += between(random, -0.01, 0.01);
        row.theta += between(random, -0.5, 0.5);
      }
    }
    out.push_back(make_hand_model(crooked, side, test::any_pose(random, 0.5), 800));
    out.push_back(make_hand_model(test::coupled(crooked), side, test::any_pose(random, 0.5), 800));
  }
  return out;
}

template <class Check>
void for_each_way(std::uint64_t seed, Check&& check) {
  std::cout << "seed " << seed << "\n";
  Random random(seed);
  for (const HandModel& hand : hands(random)) {
    for (int n = 0; n < 250; ++n) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " way " << n);
      ASSERT_NO_FATAL_FAILURE(check(random, any_way(random, hand)));
    }
  }
}

/// Expects the velocity and acceleration of the motion to be the differences of its places. Their own error is h^2 / 6 of
/// the third derivative, h^2 / 12 of the fourth, and an ulp of 1 m / h.
template <class AnyWay>
void expect_differences(const AnyWay& way) {
  const SegmentMotion motion = way.motion(0.0);
  const Vec3 x = way.place(0.0);
  const double turned = way.turned();
  const double h = 1e-4;
  const Vec3 v = (way.place(h) - way.place(-h)) / (2.0 * h);
  ASSERT_LE((v - motion.velocity(x)).norm(), motion.jerk * h * h / 6.0 + 1e-11);
  const double g = 1e-3;
  const Vec3 a = (way.place(g) - 2.0 * x + way.place(-g)) / (g * g);
  const Vec3 expected =
      motion.angular_rate.cross(x) + motion.linear_rate + motion.angular.cross(motion.velocity(x));
  ASSERT_LE((a - expected).norm(), motion.jerk * turned * g * g / 12.0 + 4e-9);
}

TEST(SegmentMotion, VelocityAndAccelerationAreTheDifferencesOfThePoses) {
  for_each_way(11, [](Random&, const Way& way) { expect_differences(way); });
}

// The bend by differences of poses alone, so that no formula of the program is trusted. Their error is the
// fourth derivative's: at most (sum |w|)^4 R h^2 / 12, and an ulp of 1 m / h^2.
TEST(SegmentMotion, BendBoundsTheSecondDifferencesAllAlongTheWay) {
  double most = 0.0;
  for_each_way(13, [&](Random& random, const Way& way) {
    const SegmentMotion motion = way.motion(0.0);
    const double s = between(random, -1.0, 1.0);
    const double h = 1e-3;
    const double bend = (way.place(s + h) - 2.0 * way.place(s) + way.place(s - h)).norm() / (h * h);
    const double turned = way.turned();
    ASSERT_LE(bend, motion.bend + motion.jerk * turned * h * h / 12.0 + 4e-9);
    if (motion.bend > 0.0) most = std::max(most, bend / motion.bend);
  });
  EXPECT_GT(most, 0.5) << "a bound, not a wall far away";
}

// One joint that turns by w = 2 a unit of s, 40 mm before a segment whose farthest point is R from it: the
// point goes round a circle at w R, is drawn to the centre by w^2 R, and that turns by w^3 R.
TEST(SegmentMotion, OfOneJointTheBoundsAreACircles) {
  const HandModel hand = test::simple_hand(Handedness::kRight, Pose{}, 800);
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    DigitPose pose;
    hand.digit_pose(test::kIndex, {}, pose);
    const SegmentMotion motion = segment_motion(hand, test::kIndex, pose, {2.0, 0.0, 0.0, 0.0}, k);
    const double bones = k == 0 ? 0.0 : test::kLength1 + (k == 1 ? 0.0 : test::kLength2);
    double own = 0.0;
    for (const Vec3& v : hand.mesh(segment_index(test::kIndex, k)).vertices) own = std::max(own, v.norm());
    const double R = bones + own;
    EXPECT_NEAR(motion.speed, 2.0 * R, 1e-15);
    EXPECT_NEAR(motion.bend, 4.0 * R, 1e-15);
    EXPECT_NEAR(motion.jerk, 8.0 * R, 1e-15);
  }
}

// Two joints at once, w = 1 and -2: V is 1, then 3.
TEST(SegmentMotion, OfTwoJointsTheBoundsAreTheSumsByHand) {
  const HandModel hand = test::simple_hand(Handedness::kRight, Pose{}, 800);
  DigitPose pose;
  hand.digit_pose(test::kIndex, {}, pose);
  const SegmentMotion motion = segment_motion(hand, test::kIndex, pose, {1.0, 0.0, -2.0, 0.0}, 1);
  const double near = hand.reach(test::kIndex, axis_of_joint(2), 1);
  const double far = hand.reach(test::kIndex, axis_of_joint(0), 1);
  EXPECT_NEAR(far - near, test::kLength1, 1e-15);
  EXPECT_NEAR(motion.speed, far + 2.0 * near, 1e-15);
  EXPECT_NEAR(motion.bend, far + (9.0 - 1.0) * near, 1e-15);
  EXPECT_NEAR(motion.jerk, far + (27.0 - 1.0) * near, 1e-15);
}

// One joint turns by 1 and two axes follow it: the metacarpal's by 0.5, then the joint, then pronation by -1. V is
// 0.5, 1.5 and 2.5. The metacarpal's axis is 50 mm before the knuckle; pronation's reach is from the next joint.
TEST(SegmentMotion, OfCoupledAxesTheBoundsAreTheSumsByHand) {
  HandParameters parameters = test::simple_parameters();
  DigitParameters& digit = parameters.digits[test::kIndex];
  digit.coupling = {.pronation_per_flexion = -1.0, .metacarpal_per_flexion = 0.5};
  digit.metacarpal_base = digit.base + Vec3(0.0, 0.0, 0.050);
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, Pose{}, 800);
  DigitPose pose;
  hand.digit_pose(test::kIndex, {}, pose);
  const DigitAngles rate{1.0, 0.0, 0.0, 0.0};
  const SegmentMotion motion = segment_motion(hand, test::kIndex, pose, rate, 1);
  const double own = hand.reach(test::kIndex, axis_of_joint(2), 1);
  const double flexion = own + test::kLength1;
  const double metacarpal = flexion + 0.050;
  EXPECT_NEAR(motion.speed, 0.5 * metacarpal + flexion + own, 1e-15);
  EXPECT_NEAR(motion.speed, segment_speed(hand, test::kIndex, rate, 1), 1e-15);
  EXPECT_NEAR(motion.bend, 0.25 * metacarpal + (2.25 - 0.25) * flexion + (6.25 - 2.25) * own, 1e-15);
  EXPECT_NEAR(motion.jerk, 0.125 * metacarpal + (3.375 - 0.125) * flexion + (15.625 - 3.375) * own, 1e-15);
  // Flexion and the metacarpal turn about -X; pronation's axis is +Z, from tip to joint, and it turns back.
  EXPECT_LT((motion.angular - Vec3(-1.5, 0.0, -1.0)).norm(), 1e-15);
}

// Abduction by 1 drives pronation by 1 alone: V is 1, then 2.
TEST(SegmentMotion, PronationByAbductionIsInTheBoundsByHand) {
  HandParameters parameters = test::simple_parameters();
  parameters.digits[test::kIndex].coupling.pronation_per_abduction = 1.0;
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, Pose{}, 800);
  DigitPose pose;
  hand.digit_pose(test::kIndex, {}, pose);
  const SegmentMotion motion = segment_motion(hand, test::kIndex, pose, {0.0, 1.0, 0.0, 0.0}, 0);
  const double along = hand.reach(test::kIndex, axis_of_joint(1), 0);
  const double beside = hand.reach(test::kIndex, kPronationAxis, 0);
  EXPECT_LT(beside, 0.2 * along);
  EXPECT_NEAR(motion.speed, along + beside, 1e-15);
  EXPECT_NEAR(motion.bend, along + 3.0 * beside, 1e-15);
  EXPECT_NEAR(motion.jerk, along + 7.0 * beside, 1e-15);
}

TEST(SegmentMotion, SpeedAndJerkBoundEveryPointAllAlongTheWay) {
  double most_speed = 0.0;
  double most_jerk = 0.0;
  for_each_way(12, [&](Random& random, const Way& way) {
    const SegmentMotion motion = way.motion(0.0);
    ASSERT_EQ(motion.speed, segment_speed(way.hand, way.digit, way.rate, way.k));
    const double s = between(random, -1.0, 1.0);
    const SegmentMotion there = way.motion(s);
    const double speed = there.velocity(way.place(s)).norm();
    ASSERT_LE(speed, motion.speed * (1.0 + 1e-12));
    // The exact acceleration's difference: its error is h^2 / 6 of the fifth derivative.
    const double h = 1e-4;
    const auto acceleration = [&](double at) {
      const SegmentMotion m = way.motion(at);
      const Vec3 x = way.place(at);
      return Vec3(m.angular_rate.cross(x) + m.linear_rate + m.angular.cross(m.velocity(x)));
    };
    const double jerk = (acceleration(s + h) - acceleration(s - h)).norm() / (2.0 * h);
    ASSERT_LE(jerk, motion.jerk * (1.0 + 1e-6) + 1e-10);
    if (motion.speed > 0.0) most_speed = std::max(most_speed, speed / motion.speed);
    if (motion.jerk > 0.0) most_jerk = std::max(most_jerk, jerk / motion.jerk);
  });
  EXPECT_GT(most_speed, 0.5) << "a bound, not a wall far away";
  EXPECT_GT(most_jerk, 0.3);
}

/// A segment of one digit as seen from a segment of another one, both on straight ways, or from a body that is fixed.
struct RelativeWay {
  const Way& way;
  const Way* carrier;
  Pose fixed;

  [[nodiscard]] Pose frame(double s) const {
    return carrier != nullptr ? carrier->pose(s).segment[static_cast<std::size_t>(carrier->k)] : fixed;
  }
  [[nodiscard]] Vec3 place(double s) const { return frame(s).inverse() * way.place(s); }
  [[nodiscard]] SegmentMotion motion(double s) const {
    const auto moving = [](const Way& of, const DigitPose& pose) {
      return MovingSegment{of.digit, of.k, pose, of.rate};
    };
    const DigitPose pose = way.pose(s);
    const Vec3 origin = pose.segment[static_cast<std::size_t>(way.k)].p;
    Sphere around{origin, 0.0};
    for (const Vec3& v : way.hand.mesh(segment_index(way.digit, way.k)).vertices)
      around.radius = std::max(around.radius, v.norm());
    if (carrier == nullptr) return relative_motion(way.hand, moving(way, pose), around, fixed, nullptr, 0.0);
    const DigitPose other = carrier->pose(s);
    const MovingSegment from = moving(*carrier, other);
    const double bound = segment_speed(way.hand, way.digit, way.rate, way.k) +
                         segment_speed(way.hand, carrier->digit, carrier->rate, carrier->k);
    return relative_motion(way.hand, moving(way, pose), around, frame(s), &from, bound);
  }
  [[nodiscard]] double turned() const {
    return way.turned() + (carrier != nullptr ? carrier->turned() : 0.0);
  }
};

template <class Check>
void for_each_relative_way(std::uint64_t seed, Check&& check) {
  for_each_way(seed, [&](Random& random, const Way& way) {
    Way carrier = any_way(random, way.hand);
    if (carrier.digit == way.digit) carrier.digit = (way.digit + 1) % kDigits;
    check(random, RelativeWay{way, &carrier, {}});
    check(random, RelativeWay{way, nullptr, test::any_pose(random, 0.5)});
  });
}

TEST(RelativeMotion, VelocityAndAccelerationAreTheDifferencesOfThePoses) {
  for_each_relative_way(14, [](Random&, const RelativeWay& way) { expect_differences(way); });
}

TEST(RelativeMotion, SpeedBendAndJerkBoundEveryPointOnTheWay) {
  double most_speed = 0.0;
  for_each_relative_way(15, [&](Random& random, const RelativeWay& way) {
    const SegmentMotion motion = way.motion(0.0);
    const double s = between(random, 0.0, 1.0);
    const SegmentMotion there = way.motion(s);
    const Vec3 x = way.place(s);
    const double speed = there.velocity(x).norm();
    ASSERT_LE(speed, motion.speed * (1.0 + 1e-12));
    if (motion.speed > 0.0) most_speed = std::max(most_speed, speed / motion.speed);
    const auto acceleration = [&](double at) {
      const SegmentMotion m = way.motion(at);
      const Vec3 y = way.place(at);
      return Vec3(m.angular_rate.cross(y) + m.linear_rate + m.angular.cross(m.velocity(y)));
    };
    ASSERT_LE(acceleration(s).norm(), motion.bend * (1.0 + 1e-12));
    const double h = 1e-4;
    const double jerk = (acceleration(s + h) - acceleration(s - h)).norm() / (2.0 * h);
    ASSERT_LE(jerk, motion.jerk * (1.0 + 1e-6) + 1e-10);
  });
  EXPECT_GT(most_speed, 0.5) << "a bound, not a wall far away";
}

}  // namespace
}  // namespace phalanx
