// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace phalanx {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

JointArray all(double angle) {
  JointArray result;
  result.fill(angle);
  return result;
}

Motion two_keys() { return {{4.0, 6.0}, {all(1.0), all(2.0)}}; }

TEST(Motion, CountsTimeFromItsFirstKey) {
  EXPECT_EQ(two_keys().duration(), 2.0);
  EXPECT_EQ(two_keys().at(0.0), all(1.0));
}

TEST(Motion, IsLinearBetweenTwoKeys) { EXPECT_EQ(two_keys().at(0.5), all(1.25)); }

TEST(Motion, HoldsTheFirstAngleBeforeAndTheLastAfter) {
  EXPECT_EQ(two_keys().at(-1.0), all(1.0));
  EXPECT_EQ(two_keys().at(2.0), all(2.0));
  EXPECT_EQ(two_keys().at(std::numeric_limits<double>::infinity()), all(2.0));
}

TEST(Motion, MeetsEachKeyExactly) {
  Motion motion;
  for (int k = 0; k < 100; ++k) {
    motion.time_s.push_back(0.25 * k);
    motion.angle.push_back(all(0.01 * k * k));
  }
  for (std::size_t k = 0; k < 100; ++k)
    EXPECT_EQ(motion.at(motion.time_s[k]), motion.angle[k]) << "key " << k;
}

TEST(Motion, TakesATimeThatIsNoNumberAsItsBegin) { EXPECT_EQ(two_keys().at(kNan), all(1.0)); }

TEST(Motion, OfOneKeyStandsStill) {
  const Motion motion{{3.0}, {all(0.5)}};
  EXPECT_EQ(motion.duration(), 0.0);
  EXPECT_EQ(motion.at(7.0), all(0.5));
}

// 0.5 at half time, 0.103515625 after a quarter: 10/64 - 15/256 + 6/1024.
TEST(Motion, IsLedInAlongAMinimumJerkProfileBeforeItsFirstKey) {
  const Motion led = led_in(two_keys(), all(0.0), 0.4);
  check_motion(led);
  EXPECT_NEAR(led.duration(), 2.4, 1e-12);
  EXPECT_EQ(led.time_s.size(), 402U);
  EXPECT_EQ(led.at(0.0), all(0.0));
  EXPECT_NEAR(led.at(0.1)[7], 0.103515625, 1e-9);
  EXPECT_NEAR(led.at(0.2)[0], 0.5, 1e-9);
  EXPECT_NEAR(led.at(0.4)[19], 1.0, 1e-9);
  EXPECT_NEAR(led.at(2.4)[19], 2.0, 1e-9);
}

TEST(Motion, IsTheSameWithoutATimeToLeadItIn) {
  const Motion same = led_in(two_keys(), all(0.0), 0.0);
  EXPECT_EQ(same.time_s, two_keys().time_s);
  EXPECT_EQ(same.angle, two_keys().angle);
}

void expect_motion_refused(const Motion& motion, const char* words) {
  try {
    check_motion(motion);
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(CheckMotion, RefusesWhatBreaksTheInvariant) {
  EXPECT_NO_THROW(check_motion(two_keys()));
  expect_motion_refused({}, "no keys");
  expect_motion_refused({{0.0, 1.0}, {all(0.0)}}, "2 times");
  expect_motion_refused({{0.0, 0.0}, {all(0.0), all(0.0)}}, "key 1: time 0 s does not come after");
  expect_motion_refused({{0.0, kNan}, {all(0.0), all(0.0)}}, "not finite");
  Motion nan = two_keys();
  nan.angle[1][5] = kNan;
  expect_motion_refused(nan, "key 1: index_mcp_abduction = nan");
}

}  // namespace
}  // namespace phalanx
