// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "phalanx/device/motion.h"

namespace phalanx {
namespace {

/// Every joint from -0.5 to 1.5 rad, open at 0.1.
HandParameters simple_hand() {
  HandParameters hand;
  hand.min_angle.fill(-0.5);
  hand.max_angle.fill(1.5);
  hand.open_angle.fill(0.1);
  return hand;
}

ScriptedMotion script(const std::string& name) {
  ScriptedMotion result;
  result.name = name;
  return result;
}

constexpr std::size_t kIndexFlexion = 4;
constexpr std::size_t kMiddleFlexion = 8;
constexpr std::size_t kLittleFlexion = 16;

TEST(ScriptedMotion, StartsAndEndsAtTheOpenHand) {
  for (const std::string& name : scripted_motion_names()) {
    ScriptedMotion shaking = script(name);
    shaking.tremor_rad = 0.05;
    const Motion motion = make_motion(shaking, simple_hand());
    EXPECT_EQ(motion.angle.front(), simple_hand().open_angle) << name;
    for (const double angle : motion.angle.back()) EXPECT_NEAR(angle, 0.1, 1e-12) << name;
  }
}

TEST(ScriptedMotion, HoldsItsInvariantAndLastsAsLongAsItsPhases) {
  for (const std::string& name : scripted_motion_names()) {
    const Motion motion = make_motion(script(name), simple_hand());
    EXPECT_NO_THROW(check_motion(motion)) << name;
    EXPECT_DOUBLE_EQ(motion.duration(), 0.2 + 1.0 + 1.0 + 1.0) << name;
  }
}

// 3.2005 s are no whole number of milliseconds: the last key is at the end all the same.
TEST(ScriptedMotion, EndsWithItsLastPhaseBetweenTwoKeys) {
  ScriptedMotion longer = script("press");
  longer.hold_s = 1.0005;
  const Motion motion = make_motion(longer, simple_hand());
  EXPECT_DOUBLE_EQ(motion.duration(), 3.2005);
  EXPECT_NEAR(motion.angle.back()[kIndexFlexion], 0.1, 1e-12);
}

// Open 0.1, end of range 1.5, closure 0.6: the hold is at 0.1 + 0.6 * 1.4 = 0.94, by hand.
TEST(ScriptedMotion, ClosesByItsClosureOfTheWayToTheEndOfTheRange) {
  const Motion motion = make_motion(script("press"), simple_hand());
  EXPECT_NEAR(motion.at(1.7)[kIndexFlexion], 0.94, 1e-12);
  EXPECT_EQ(motion.at(1.7)[kMiddleFlexion], 0.1);
}

// Halfway through a minimum-jerk movement half the way is gone; a quarter: 10/64 - 15/256 + 6/1024 =
// 0.103515625.
TEST(ScriptedMotion, FollowsTheMinimumJerkProfile) {
  const Motion motion = make_motion(script("press"), simple_hand());
  EXPECT_NEAR(motion.at(0.7)[kIndexFlexion], 0.1 + 0.84 * 0.5, 1e-9);
  EXPECT_NEAR(motion.at(0.45)[kIndexFlexion], 0.1 + 0.84 * 0.103515625, 1e-9);
  EXPECT_NEAR(motion.at(2.7)[kIndexFlexion], 0.1 + 0.84 * 0.5, 1e-9) << "opening";
}

TEST(ScriptedMotion, MovesTheDigitsOfItsKindAndNoOthers) {
  const std::vector<std::pair<std::string, std::array<bool, kDigits>>> expected = {
      {"press", {false, true, false, false, false}},
      {"pinch", {true, true, false, false, false}},
      {"tripod", {true, true, true, false, false}},
      {"power_grasp", {true, true, true, true, true}},
      {"wave", {false, true, true, true, true}}};
  for (const auto& [name, moves] : expected) {
    const JointArray held = make_motion(script(name), simple_hand()).at(1.7);
    for (int digit = 0; digit < kDigits; ++digit) {
      const auto first = static_cast<std::size_t>(joint_index(digit, 0));
      EXPECT_EQ(held[first] != 0.1, moves[static_cast<std::size_t>(digit)])
          << name << ", " << digit_name(digit);
    }
  }
}

TEST(ScriptedMotion, TakesJointsToAPostureOfOnesOwn) {
  ScriptedMotion posture = script("posture");
  posture.closure = 1.0;
  posture.posture[kIndexFlexion] = 0.7;
  posture.posture[kMiddleFlexion] = 100.0;
  const JointArray held = make_motion(posture, simple_hand()).at(1.7);
  EXPECT_NEAR(held[kIndexFlexion], 0.7, 1e-12);
  EXPECT_EQ(held[kMiddleFlexion], simple_hand().max_angle[kMiddleFlexion]) << "the range of motion ends it";
  EXPECT_EQ(held[kLittleFlexion], 0.1) << "without an angle it stays open";
  posture.closure = 0.5;
  EXPECT_NEAR(make_motion(posture, simple_hand()).at(1.7)[kIndexFlexion], 0.5 * (0.1 + 0.7), 1e-12);
  posture.posture[kIndexFlexion] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(make_motion(posture, simple_hand())), std::invalid_argument);
}

// Half way through the closing each digit that moves is half closed: 0.1 + 0.84 / 2.
TEST(ScriptedMotion, ClosesAllDigitsAtOnceUnlessItWaves) {
  for (const std::string name : {"press", "pinch", "tripod", "power_grasp"}) {
    const Motion motion = make_motion(script(name), simple_hand());
    for (int digit = 0; digit < kDigits; ++digit) {
      const auto first = static_cast<std::size_t>(joint_index(digit, 0));
      const bool moves = motion.at(1.7)[first] != 0.1;
      EXPECT_NEAR(motion.at(0.7)[first], moves ? 0.52 : 0.1, 1e-9) << name << ", " << digit_name(digit);
    }
  }
}

// At closure 0.6 a joint that goes all the way is at 0.94. The thumb flexes and opposes all the way and bends
// its two hinges 0.6 of it; a finger does not spread, and bends its end joint 0.7 of the way.
TEST(ScriptedMotion, ClosesEachJointOfADigitByItsWeight) {
  const JointArray held = make_motion(script("power_grasp"), simple_hand()).at(1.7);
  constexpr std::array<double, kJointsPerDigit> kThumb = {1.0, 1.0, 0.6, 0.6};
  constexpr std::array<double, kJointsPerDigit> kFinger = {1.0, 0.0, 1.0, 0.7};
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j % kJointsPerDigit);
    const double weight = digit_of_joint(j) == 0 ? kThumb[i] : kFinger[i];
    EXPECT_NEAR(held[static_cast<std::size_t>(j)], 0.1 + 0.84 * weight, 1e-12) << joint_name(j);
  }
}

// In a pinch the thumb's hinges stay nearly straight: 0.25 and 0.2 of the way.
TEST(ScriptedMotion, APinchMeetsTheFingersWithTheThumbsPad) {
  const JointArray held = make_motion(script("pinch"), simple_hand()).at(1.7);
  EXPECT_NEAR(held[0], 0.1 + 0.84, 1e-12);
  EXPECT_NEAR(held[1], 0.1 + 0.84, 1e-12);
  EXPECT_NEAR(held[2], 0.1 + 0.84 * 0.25, 1e-12);
  EXPECT_NEAR(held[3], 0.1 + 0.84 * 0.2, 1e-12);
}

// A joint that closes at -0.2 goes 0.6 of the way from 0.1 to there.
TEST(ScriptedMotion, AJointClosesToItsClosedAngle) {
  HandParameters hand = simple_hand();
  hand.closed_angle[1] = -0.2;
  const JointArray held = make_motion(script("power_grasp"), hand).at(1.7);
  EXPECT_NEAR(held[0], 0.1 + 0.6 * 1.4, 1e-12);
  EXPECT_NEAR(held[1], 0.1 - 0.6 * 0.3, 1e-12);
}

TEST(ScriptedMotion, WavesTheLittleFingerBeforeTheIndex) {
  const Motion motion = make_motion(script("wave"), simple_hand());
  EXPECT_NEAR(motion.at(0.7)[kLittleFlexion], 0.94, 1e-9);
  EXPECT_LT(motion.at(0.7)[kIndexFlexion], 0.4);
}

TEST(ScriptedMotion, RepeatsItself) {
  ScriptedMotion twice = script("press");
  twice.repeat = 2;
  const Motion motion = make_motion(twice, simple_hand());
  EXPECT_DOUBLE_EQ(motion.duration(), 6.4);
  EXPECT_NEAR(motion.at(3.2 + 0.7)[kIndexFlexion], motion.at(0.7)[kIndexFlexion], 1e-3);
}

TEST(ScriptedMotion, ClosesEachDigitByItsShare) {
  ScriptedMotion shares = script("power_grasp");
  shares.digit_closure = {1.0, 0.5, 0.0, 1.0, 1.0};
  const JointArray held = make_motion(shares, simple_hand()).at(1.7);
  EXPECT_NEAR(held[kIndexFlexion], 0.1 + 0.42, 1e-12);
  EXPECT_EQ(held[kMiddleFlexion], 0.1);
}

TEST(ScriptedMotion, NeverLeavesTheRangeOfMotionHoweverHardItShakes) {
  ScriptedMotion shaking = script("power_grasp");
  shaking.closure = 1.0;
  shaking.tremor_rad = 3.0;
  for (const JointArray& angle : make_motion(shaking, simple_hand()).angle) {
    EXPECT_GE(*std::min_element(angle.begin(), angle.end()), -0.5);
    EXPECT_LE(*std::max_element(angle.begin(), angle.end()), 1.5);
  }
}

TEST(Tremor, StaysWithinItsBoundAndShakesWhatMoves) {
  ScriptedMotion still = script("press");
  ScriptedMotion shaking = still;
  shaking.tremor_rad = 0.02;
  const Motion a = make_motion(still, simple_hand());
  const Motion b = make_motion(shaking, simple_hand());
  double largest = 0.0;
  for (std::size_t k = 0; k < a.angle.size(); ++k) {
    largest = std::max(largest, std::abs(a.angle[k][kIndexFlexion] - b.angle[k][kIndexFlexion]));
    EXPECT_EQ(a.angle[k][kMiddleFlexion], b.angle[k][kMiddleFlexion]);
  }
  EXPECT_GT(largest, 0.005);
  EXPECT_LE(largest, 0.02 + 1e-12);
}

TEST(Tremor, IsTheSameForTheSameSeedAndAnotherForAnother) {
  ScriptedMotion shaking = script("press");
  shaking.tremor_rad = 0.02;
  const Motion first = make_motion(shaking, simple_hand());
  EXPECT_EQ(first.angle, make_motion(shaking, simple_hand()).angle);
  shaking.seed = 2;
  EXPECT_NE(first.angle, make_motion(shaking, simple_hand()).angle);
}

TEST(ScriptedMotion, AnswersAnUnknownNameWithTheNearestOne) {
  try {
    static_cast<void>(make_motion(script("pinsh"), simple_hand()));
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("\"pinsh\""));
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean \"pinch\"?"));
  }
}

TEST(ScriptedMotion, RefusesParametersOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    ScriptedMotion bad = script("press");
    change(bad);
    EXPECT_THROW(static_cast<void>(make_motion(bad, simple_hand())), std::invalid_argument);
  };
  refused([](ScriptedMotion& s) { s.start_s = -1.0; });
  refused([](ScriptedMotion& s) { s.close_s = 0.0; });
  refused([&](ScriptedMotion& s) { s.hold_s = nan; });
  refused([](ScriptedMotion& s) { s.open_s = std::numeric_limits<double>::infinity(); });
  refused([](ScriptedMotion& s) { s.repeat = 0; });
  refused([](ScriptedMotion& s) { s.closure = 1.5; });
  refused([](ScriptedMotion& s) { s.digit_closure[2] = -0.1; });
  refused([](ScriptedMotion& s) { s.tremor_rad = -0.1; });
  refused([](ScriptedMotion& s) { s.key_rate_hz = 0.0; });
  refused([](ScriptedMotion& s) { s.repeat = 1'000'000'000; });
}

}  // namespace
}  // namespace phalanx
