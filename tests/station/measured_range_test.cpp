// SPDX-License-Identifier: Apache-2.0
// A hand that reaches 40 degrees of PIP: its range is measured through the device, and then the gate commands the same
// device with a torque that bends the relaxed finger.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>

#include "device/calibration/reaching_hand.h"
#include "phalanx/device/range_session.h"
#include "station/safety.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr int kPipOfIndex = joint_index(1, 2);
constexpr double kReached = 40.0 * kDeg;

MeasuredRange measured(test::ReachingHand& hand) {
  RangeSession session(hand, hand.info().channels, test::simple_parameters());
  double now = 0.0;
  const auto pass = [&](double seconds) {
    for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) session.update(now += 1e-3);
  };
  session.measure(now);
  for (const double angle : {0.0, 90.0 * kDeg, 0.0}) {
    hand.intend({angle, 0.0, angle, angle});
    pass(3.0);
  }
  session.accept();
  return *session.range();
}

/// @returns the largest PIP angle of the relaxed finger while 0.4 Nm are asked for, for 5 s [rad]
double pushed_to(test::ReachingHand& hand, const JointRanges& range, double torque) {
  SafetySettings settings;
  settings.range = range;
  const ChannelMap map(hand.info().channels, {}, test::simple_parameters());
  Safety safety(settings, map, hand.info(), test::simple_parameters(), {}, test::ReachingHand::kPeriod);
  hand.relax();
  Snapshot snapshot;
  DeviceCommand command;
  std::array<DeviceSample, 1> sample;
  Sample angles;
  double furthest = hand.pip();
  for (int i = 1; i <= 5000; ++i) {
    const double now = 100.0 + i * test::ReachingHand::kPeriod;
    static_cast<void>(hand.receive(now, sample));
    map.convert(sample[0], angles);
    snapshot.hcp_angle = angles.angle;
    snapshot.torque[idx(kPipOfIndex)] = torque;
    safety.observe(sample, Fault::kNone, false, now);
    safety.command(snapshot, sample[0], now, command);
    hand.send(command);
    furthest = torque > 0.0 ? std::max(furthest, hand.pip()) : std::min(furthest, hand.pip());
  }
  EXPECT_EQ(safety.fault().fault, Fault::kNone);
  return furthest;
}

TEST(MeasuredRangeGate, TheGateDoesNotPushAJointBeyondWhatThePatientReached) {
  test::ReachingHand hand(kReached);
  const MeasuredRange range = measured(hand);
  const AngleRange pip = *range.joint[idx(kPipOfIndex)];
  EXPECT_NEAR(pip.max, kReached, 3.0 * kDeg);
  // The noise of the sensor opens the gate for single steps at its end.
  const double furthest = pushed_to(hand, range.joint, 0.4);
  EXPECT_LT(furthest, pip.max + 3.0 * test::ReachingHand::kNoise);
  EXPECT_GT(furthest, pip.max - 3.0 * kDeg) << "up to there it is pushed";
}

TEST(MeasuredRangeGate, HoldsInBothDirections) {
  test::ReachingHand hand(kReached);
  const MeasuredRange range = measured(hand);
  const double furthest = pushed_to(hand, range.joint, -0.4);
  EXPECT_GT(furthest, range.joint[idx(kPipOfIndex)]->min - 3.0 * test::ReachingHand::kNoise);
}

// Without a measured range the hand's own limit holds, 2 rad.
TEST(MeasuredRangeGate, WithoutOneTheLimitsOfTheHandHold) {
  test::ReachingHand hand(kReached);
  static_cast<void>(measured(hand));
  const double furthest = pushed_to(hand, {}, 0.4);
  EXPECT_GT(furthest, kReached + 20.0 * kDeg);
  EXPECT_LT(furthest, 2.0 + 3.0 * test::ReachingHand::kNoise);
}

// A range that is wider than the hand's does not widen it.
TEST(MeasuredRangeGate, NeverWidensTheLimitsOfTheHand) {
  test::ReachingHand hand(kReached);
  JointRanges wide{};
  wide[idx(kPipOfIndex)] = AngleRange{.min = -3.0, .max = 3.0};
  EXPECT_LT(pushed_to(hand, wide, 0.4), 2.0 + 3.0 * test::ReachingHand::kNoise);
}

}  // namespace
}  // namespace phalanx
