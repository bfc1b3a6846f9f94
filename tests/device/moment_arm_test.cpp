// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/moment_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "device/two_joint_device.h"
#include "phalanx/core/random.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kDegree = std::numbers::pi / 180.0;

JointLinkage polynomial() {
  return {
      .joint = test::kMcp, .min_angle = -0.5, .max_angle = 1.5, .polynomial = {-0.012, 0.002, -0.001, 3e-4}};
}

JointLinkage table() {
  return {.joint = test::kMcp,
          .min_angle = 0.0,
          .max_angle = 1.5,
          .table = {{0.0, 0.010}, {0.5, 0.012}, {1.0, 0.008}, {1.5, 0.006}}};
}

/// r = c0 + c1 q by hand: at 1 rad, e = c0 + c1 / 2.
TEST(MomentArm, OfAPolynomialIsItsValueAndTheExcursionItsIntegral) {
  const JointLinkage line = {.min_angle = 0.0, .max_angle = 2.0, .polynomial = {0.010, 0.004}};
  EXPECT_DOUBLE_EQ(moment_arm(line, 1.0), 0.014);
  EXPECT_DOUBLE_EQ(excursion(line, 1.0), 0.012);
  EXPECT_EQ(excursion(line, 0.0), 0.0);
}

/// By hand: 10 to 12 mm over 0.5 rad, then 12 to 10 mm over 0.25 rad: 5.5 mm + 2.75 mm.
TEST(MomentArm, OfATableIsLinearBetweenThePoints) {
  EXPECT_NEAR(moment_arm(table(), 0.75), 0.010, 1e-15);
  EXPECT_NEAR(excursion(table(), 0.75), 0.00825, 1e-15);
  EXPECT_DOUBLE_EQ(moment_arm(table(), 1.5), 0.006);
}

// In a parallelogram the crank turns with the rocker.
TEST(MomentArm, OfAParallelogramIsTheDrum) {
  const JointLinkage linkage = {.min_angle = 0.0,
                                .max_angle = 1.5,
                                .four_bar = FourBar{.ground = 0.03,
                                                    .crank = 0.012,
                                                    .coupler = 0.03,
                                                    .rocker = 0.012,
                                                    .rocker_angle = 0.7,
                                                    .crossed = false,
                                                    .drum = 0.009}};
  for (const double q : {0.0, 0.4, 0.8, 1.5}) {
    EXPECT_NEAR(moment_arm(linkage, q), 0.009, 1e-12);
    EXPECT_NEAR(excursion(linkage, q), 0.009 * q, 1e-12);
  }
}

/// Solves  ground + rocker e^(i theta) = crank e^(i psi) + coupler e^(i phi)  for psi and phi by Newton's
/// method.
void close_loop(const FourBar& bar, double theta, double& psi, double& phi) {
  for (int i = 0; i < 50; ++i) {
    const double fx =
        bar.ground + bar.rocker * std::cos(theta) - bar.crank * std::cos(psi) - bar.coupler * std::cos(phi);
    const double fy = bar.rocker * std::sin(theta) - bar.crank * std::sin(psi) - bar.coupler * std::sin(phi);
    const double a = bar.crank * std::sin(psi);
    const double b = bar.coupler * std::sin(phi);
    const double c = -bar.crank * std::cos(psi);
    const double d = -bar.coupler * std::cos(phi);
    const double determinant = a * d - b * c;
    psi -= (d * fx - b * fy) / determinant;
    phi -= (a * fy - c * fx) / determinant;
  }
}

// An independent solution: Newton's method on the loop, followed from angle to angle.
TEST(MomentArm, OfAFourBarLinkageAgreesWithTheNumericClosureOfItsLoop) {
  for (const bool crossed : {false, true}) {
    JointLinkage linkage = test::four_bar_linkage(test::kMcp);
    linkage.four_bar->crossed = crossed;
    linkage.max_angle = 60.0 * kDegree;
    const FourBar& bar = *linkage.four_bar;
    // A start by bisection over the crank's angle: the distance of its end from B is the coupler.
    const double theta = bar.rocker_angle + linkage.min_angle;
    const double bx = bar.ground + bar.rocker * std::cos(theta);
    const double by = bar.rocker * std::sin(theta);
    const double towards = std::atan2(by, bx);
    double near = towards;
    double far = towards + (crossed ? -std::numbers::pi : std::numbers::pi);
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (near + far);
      const double distance =
          std::hypot(bx - bar.crank * std::cos(middle), by - bar.crank * std::sin(middle));
      (distance < bar.coupler ? near : far) = middle;
    }
    double psi = near;
    double phi = std::atan2(by - bar.crank * std::sin(psi), bx - bar.crank * std::cos(psi));
    const double start = psi;
    const double at_start = excursion(linkage, linkage.min_angle);
    for (int i = 0; i <= 100; ++i) {
      const double q = linkage.min_angle + 0.01 * i * (linkage.max_angle - linkage.min_angle);
      close_loop(bar, bar.rocker_angle + q, psi, phi);
      ASSERT_NEAR(excursion(linkage, q) - at_start, bar.drum * (psi - start), 1e-11)
          << crossed << " at " << q;
    }
  }
}

TEST(MomentArm, IsTheDerivativeOfTheExcursion) {
  Random random(3);
  for (const JointLinkage& linkage : {polynomial(), table(), test::four_bar_linkage(test::kMcp)}) {
    for (int i = 0; i < 200; ++i) {
      const double q =
          linkage.min_angle - 0.3 + random.uniform() * (linkage.max_angle - linkage.min_angle + 0.6);
      constexpr double kStep = 1e-6;
      const double numeric = (excursion(linkage, q + kStep) - excursion(linkage, q - kStep)) / (2.0 * kStep);
      ASSERT_NEAR(moment_arm(linkage, q), numeric, 3e-8) << q;
    }
  }
}

TEST(MomentArm, TheAngleOfAnExcursionIsItsInverse) {
  Random random(4);
  for (const JointLinkage& linkage : {polynomial(), table(), test::four_bar_linkage(test::kMcp)}) {
    for (int i = 0; i < 200; ++i) {
      const double q =
          linkage.min_angle - 0.3 + random.uniform() * (linkage.max_angle - linkage.min_angle + 0.6);
      ASSERT_NEAR(angle_of_excursion(linkage, excursion(linkage, q)), q, 1e-9);
    }
  }
}

TEST(MomentArm, BeyondTheRangeItKeepsItsValueAtTheEnd) {
  const JointLinkage linkage = test::four_bar_linkage(test::kMcp);
  const double arm = moment_arm(linkage, linkage.max_angle);
  EXPECT_EQ(moment_arm(linkage, linkage.max_angle + 0.4), arm);
  EXPECT_NEAR(excursion(linkage, linkage.max_angle + 0.4), excursion(linkage, linkage.max_angle) + 0.4 * arm,
              1e-15);
}

TEST(MomentArm, ItsExtremesAreThoseOfTheRange) {
  EXPECT_DOUBLE_EQ(largest_arm(table()), 0.012);
  EXPECT_DOUBLE_EQ(least_arm(table()), 0.006);
  JointLinkage negative = table();
  for (ArmPoint& point : negative.table) point.arm = -point.arm;
  EXPECT_DOUBLE_EQ(largest_arm(negative), -0.012);
}

TEST(MomentArm, AllocatesNothing) {
  const JointLinkage all[] = {polynomial(), table(), test::four_bar_linkage(test::kMcp)};
  const std::size_t before = test::allocations_of_this_thread();
  double sum = 0.0;
  for (const JointLinkage& linkage : all)
    sum += moment_arm(linkage, 0.3) + excursion(linkage, 0.3) + angle_of_excursion(linkage, 0.001);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

void expect_refused(const JointLinkage& linkage, const std::vector<std::string>& words) {
  try {
    check_linkage(linkage, "motor m, linkage of j");
    ADD_FAILURE() << "accepted; expected " << testing::PrintToString(words);
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("motor m, linkage of j: "));
    for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
  }
}

TEST(MomentArm, WhatIsNotMonotoneOrSingularIsRefusedWithAngleValueAndRemedy) {
  EXPECT_NO_THROW(check_linkage(polynomial(), "p"));
  EXPECT_NO_THROW(check_linkage(table(), "t"));
  EXPECT_NO_THROW(check_linkage(test::four_bar_linkage(test::kMcp), "f"));
  // Zero at 0.5 rad, 28.6 deg.
  expect_refused({.min_angle = 0.0, .max_angle = 1.0, .polynomial = {0.010, -0.020}},
                 {"at 28.", "moment arm is 0.", "cannot hold the joint", "narrow the range"});
  JointLinkage other_sign = table();
  other_sign.table[3].arm = -0.006;
  expect_refused(other_sign, {"keep its sign", "Change the numbers"});
  JointLinkage large = table();
  large.table[1].arm = 12.0;
  expect_refused(large, {"its unit may be wrong", "100 mm"});
}

// The range is checked at 2000 equal angles, 0.75 mrad apart. These points are narrower, and lie between two.
TEST(MomentArm, APointOfATableBetweenTwoCheckedAnglesIsCheckedToo) {
  const auto with_point = [](double arm) {
    JointLinkage linkage = table();
    constexpr double kBetween = 1000.5 * 1.5 / 2000.0;
    linkage.table = {
        {0.0, 0.010}, {kBetween - 1e-4, 0.010}, {kBetween, arm}, {kBetween + 1e-4, 0.010}, {1.5, 0.010}};
    return linkage;
  };
  EXPECT_NO_THROW(check_linkage(with_point(0.0003), "t"));
  expect_refused(with_point(0.0001), {"at 43.0 deg the moment arm is 0.100 mm", "cannot hold the joint"});
  expect_refused(with_point(-0.010), {"at 43.0 deg the moment arm is -10.000 mm", "keep its sign"});
  expect_refused(with_point(0.2), {"at 43.0 deg the moment arm is 200.000 mm", "its unit may be wrong"});
  JointLinkage outside = with_point(0.2);  // beyond the range a point does not count
  outside.max_angle = 0.7;
  EXPECT_NO_THROW(check_linkage(outside, "t"));
}

// Rocker and coupler in line: at the dead centre the motor cannot turn the joint. By hand: crank 10, coupler
// 20, rocker 25, ground 30 mm.
TEST(MomentArm, AFourBarLinkageThatPassesADeadCentreOrCannotCloseIsRefused) {
  JointLinkage linkage = {.min_angle = 0.0,
                          .max_angle = 150.0 * kDegree,
                          .four_bar = FourBar{.ground = 0.030,
                                              .crank = 0.010,
                                              .coupler = 0.020,
                                              .rocker = 0.025,
                                              .rocker_angle = 100.0 * kDegree,
                                              .crossed = false,
                                              .drum = 0.01}};
  expect_refused(linkage,
                 {"the rocker's end is", "crank and coupler reach 10.00 to 30.00 mm", "Change a length"});
  linkage = test::four_bar_linkage(test::kMcp);
  linkage.min_angle = -90.0 * kDegree;
  expect_refused(linkage, {"at -8", "coupler and rocker are in line", "keep its sign"});
}

TEST(MomentArm, NumbersThatAreNoneAndShapesThatDisagreeAreRefused) {
  JointLinkage none = polynomial();
  none.polynomial.clear();
  expect_refused(none, {"0 of polynomial, table and four-bar", "exactly one"});
  JointLinkage both = polynomial();
  both.table = table().table;
  expect_refused(both, {"2 of polynomial"});
  JointLinkage reversed = polynomial();
  std::swap(reversed.min_angle, reversed.max_angle);
  expect_refused(reversed, {"must increase", "swap"});
  JointLinkage unsorted = table();
  std::swap(unsorted.table[1], unsorted.table[2]);
  expect_refused(unsorted, {"sort the points"});
  JointLinkage short_table = table();
  short_table.max_angle = 2.0;
  expect_refused(short_table, {"the table ends at 0.0 and 85.9 deg", "narrow the range"});
  JointLinkage no_length = test::four_bar_linkage(test::kMcp);
  no_length.four_bar->crank = 0.0;
  expect_refused(no_length, {"crank = 0 mm", "must be above 0"});
  JointLinkage no_drum = test::four_bar_linkage(test::kMcp);
  no_drum.four_bar->drum = 0.0;
  expect_refused(no_drum, {"drum not 0"});
  JointLinkage not_finite = polynomial();
  not_finite.polynomial[0] = std::nan("");
  expect_refused(not_finite, {"coefficient", "must be finite"});
}

TEST(MomentArm, ADeviceIsRefusedWithALinkageThatItsMotorDoesNotHave) {
  Exoskeleton exo = test::two_joint_device();
  add_linkage(exo.motors[0], test::four_bar_linkage(test::kMcp));
  EXPECT_NO_THROW(check_exoskeleton(exo));
  exo.motors[0].arm[test::kMcp] = -0.0125;
  EXPECT_THAT([&] { check_exoskeleton(exo); }, ThrowsMessage<std::invalid_argument>(AllOf(
                                                   HasSubstr("motor mcp"), HasSubstr("add_linkage()"))));
  exo = test::two_joint_device();
  add_linkage(exo.motors[0], test::four_bar_linkage(test::kMcp));
  add_linkage(exo.motors[0], table());
  EXPECT_THAT([&] { check_exoskeleton(exo); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is there twice")));
}

}  // namespace
}  // namespace phalanx
