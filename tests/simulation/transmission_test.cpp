// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/transmission.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "device/two_joint_device.h"
#include "phalanx/core/random.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using test::motor_on;
using test::two_joint_device;

JointArray torque_on(int joint, double value) {
  JointArray torque{};
  torque[static_cast<std::size_t>(joint)] = value;
  return torque;
}

Rendered render(const Exoskeleton& exo, const JointArray& wanted) {
  Rendered rendered;
  Transmission(exo).render(wanted, rendered);
  return rendered;
}

// -0.0625 Nm on an arm of -12.5 mm is 5 N, by hand; at 2 N/A that is 2.5 A.
TEST(Transmission, PullsEachMotorsOwnJointExactly) {
  Exoskeleton exo = two_joint_device();
  exo.motors[0].force_constant = 2.0;
  const Rendered r = render(exo, torque_on(4, -0.0625));
  EXPECT_EQ(r.force[0], 5.0);
  EXPECT_EQ(r.current[0], 2.5);
  EXPECT_EQ(r.force[1], 0.0);
  EXPECT_EQ(r.torque[4], -0.0625);
  for (const double rest : r.unrendered) EXPECT_EQ(rest, 0.0);
  EXPECT_FALSE(r.saturated);
}

// 10 N on 12.5 mm are 0.125 Nm; of the 0.2 Nm asked for, 0.075 are felt by nobody.
TEST(Transmission, SaysWhatItsForceLimitLeavesUnrendered) {
  const Rendered r = render(two_joint_device(), torque_on(4, 0.2));
  EXPECT_EQ(r.force[0], -10.0);
  EXPECT_TRUE(r.saturated);
  EXPECT_EQ(r.torque[4], 0.125);
  EXPECT_DOUBLE_EQ(r.unrendered[4], 0.075);
}

TEST(Transmission, ReportsAllOfATorqueThatNoMotorReaches) {
  const Rendered r = render(two_joint_device(), torque_on(10, 0.03));
  EXPECT_EQ(r.unrendered[10], 0.03);
  for (const double force : r.force) EXPECT_EQ(force, 0.0);
}

// Virtual work: the DIP turns half as far as the PIP, so that its torque does half as much on the PIP.
TEST(Transmission, MovesACoupledJointsTorqueToTheJointThatItFollows) {
  const Rendered r = render(two_joint_device(), torque_on(7, -0.1));
  EXPECT_EQ(r.asked[6], -0.05);
  EXPECT_EQ(r.asked[7], 0.0);
  EXPECT_EQ(r.force[1], 5.0);
  EXPECT_EQ(r.unrendered[6], 0.0);
  EXPECT_EQ(r.unrendered[7], 0.0);
}

// A tendon that only pulls cannot push; one with 2 N of bias can let go of those 2 N.
TEST(Transmission, LetsAPullOnlyTendonGoOfItsBiasButNoMore) {
  Exoskeleton exo = two_joint_device();
  exo.motors[0].pull_only = true;
  EXPECT_EQ(render(exo, torque_on(4, 0.05)).force[0], 0.0);
  EXPECT_FALSE(render(exo, torque_on(4, 0.05)).saturated);
  exo.motors[0].bias = 2.0;
  const Rendered r = render(exo, torque_on(4, 0.05));
  EXPECT_EQ(r.force[0], -2.0);
  EXPECT_EQ(r.current[0], 0.0);
  EXPECT_DOUBLE_EQ(r.unrendered[4], 0.05 - 0.025);
  EXPECT_EQ(render(exo, torque_on(4, -1.0)).force[0], 8.0);  // with the bias: the limit of 10 N
}

// Two equal tendons on one joint share its torque alike: any other split is more effort. Least effort is
// promised to 1e-5.
TEST(Transmission, SharesEquallyAmongEqualMotors) {
  Exoskeleton exo = two_joint_device();
  exo.motors.push_back(motor_on("mcp_too", 4, -0.0125));
  const Rendered r = render(exo, torque_on(4, -0.125));
  EXPECT_NEAR(r.force[0], 5.0, 1e-5 * 5.0);
  EXPECT_NEAR(r.force[2], 5.0, 1e-5 * 5.0);
  EXPECT_NEAR(r.unrendered[4], 0.0, 1e-9);
}

/// Leaves what is no number on the part of the stack that the next call uses.
[[gnu::noinline]] void leave_nothing_sensible_on_the_stack() {
  std::array<double, 8192> used;
  used.fill(std::numeric_limits<double>::quiet_NaN());
  const double* held = used.data();
  asm volatile("" : : "r"(held) : "memory");
}

TEST(Transmission, SharesAmongMotorsWhateverTheStackHeld) {
  Exoskeleton exo = two_joint_device();
  exo.motors.push_back(motor_on("mcp_too", 4, -0.0125));
  const Transmission transmission(exo);
  const JointArray wanted = torque_on(4, -0.125);
  Rendered r;
  leave_nothing_sensible_on_the_stack();
  transmission.render(wanted, r);
  EXPECT_NEAR(r.force[0], 5.0, 1e-5 * 5.0);
  EXPECT_NEAR(r.force[2], 5.0, 1e-5 * 5.0);
}

// An antagonist pair of tendons that only pull: one pulls, the other rests.
TEST(Transmission, DrivesAnAntagonistPairEachWay) {
  Exoskeleton exo = two_joint_device();
  exo.motors[0].pull_only = true;
  exo.motors.push_back(motor_on("mcp_flexor", 4, 0.0125));
  exo.motors[2].pull_only = true;
  for (const double sign : {1.0, -1.0}) {
    const Rendered r = render(exo, torque_on(4, sign * 0.0625));
    EXPECT_NEAR(r.force[0], sign < 0 ? 5.0 : 0.0, 1e-6);
    EXPECT_NEAR(r.force[2], sign > 0 ? 5.0 : 0.0, 1e-6);
  }
}

/// Every motor on a bound or free, all 3^n ways; the free ones by a least-squares solution of least norm. The
/// best one that is inside the bounds is the least effort among the least residuals.
std::vector<double> best_by_brute_force(const Exoskeleton& exo, const JointArray& asked) {
  const std::size_t n = exo.motors.size();
  std::size_t ways = 1;
  for (std::size_t m = 0; m < n; ++m) ways *= 3;
  std::vector<double> best;
  double best_residual = std::numeric_limits<double>::infinity();
  double best_effort = best_residual;
  for (std::size_t way = 0; way < ways; ++way) {
    std::vector<double> x(n, 0.0);
    std::vector<std::size_t> free;
    Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(asked.data(), kJoints);
    const auto arm = [&](std::size_t m) {
      return Eigen::Map<const Eigen::VectorXd>(exo.motors[m].arm.data(), kJoints);
    };
    for (std::size_t m = 0, digits = way; m < n; ++m, digits /= 3) {
      const ExoMotor& motor = exo.motors[m];
      if (digits % 3 == 0) {
        free.push_back(m);
        continue;
      }
      x[m] = digits % 3 == 2 ? motor.force_limit - motor.bias
                             : (motor.pull_only ? -motor.bias : -motor.force_limit);
      rest -= x[m] * arm(m);
    }
    if (!free.empty()) {
      Eigen::MatrixXd A(kJoints, static_cast<Eigen::Index>(free.size()));
      for (std::size_t k = 0; k < free.size(); ++k) A.col(static_cast<Eigen::Index>(k)) = arm(free[k]);
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
      solver.setThreshold(1e-9);
      const Eigen::VectorXd forces = solver.compute(A).solve(rest);
      rest -= A * forces;
      bool inside = true;
      for (std::size_t k = 0; k < free.size(); ++k) {
        const ExoMotor& motor = exo.motors[free[k]];
        x[free[k]] = forces[static_cast<Eigen::Index>(k)];
        const double least = motor.pull_only ? -motor.bias : -motor.force_limit;
        inside = inside && x[free[k]] >= least - 1e-9 && x[free[k]] <= motor.force_limit - motor.bias + 1e-9;
      }
      if (!inside) continue;
    }
    double effort = 0.0;
    for (const double f : x) effort += f * f;
    const double residual = rest.norm();
    if (residual < best_residual - 1e-10 || (residual < best_residual + 1e-10 && effort < best_effort)) {
      best_residual = std::min(residual, best_residual);
      best_effort = effort;
      best = x;
    }
  }
  return best;
}

/// One to five motors with one to three arms each on one to four joints: some redundant, some deficient.
Exoskeleton random_device(Random& random) {
  Exoskeleton exo;
  const int joints = 1 + static_cast<int>(4 * random.uniform());
  for (int j = 0; j < joints; ++j) exo.joints.push_back(test::joint_of(4 + j));
  const int motors = 1 + static_cast<int>(5 * random.uniform());
  for (int m = 0; m < motors; ++m) {
    std::string name = "m";
    name += std::to_string(m);
    ExoMotor motor = motor_on(name, 4 + static_cast<int>(joints * random.uniform()), 0.01);
    for (int extra = 0; extra < 3; ++extra) {
      const auto j = static_cast<std::size_t>(4 + static_cast<int>(joints * random.uniform()));
      const double size = random.between(0.004, 0.015);
      motor.arm[j] = random.uniform() < 0.5 ? -size : size;
    }
    motor.pull_only = random.uniform() < 0.5;
    motor.force_limit = random.between(2.0, 20.0);
    if (motor.pull_only && random.uniform() < 0.5) motor.bias = random.between(0.0, 2.0);
    exo.motors.push_back(motor);
  }
  return exo;
}

TEST(Transmission, FindsTheLeastEffortAmongTheBestForcesOfRandomDevices) {
  constexpr std::uint64_t kSeed = 20260801;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Random random(kSeed);
  int saturated = 0;
  int redundant = 0;
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    const Exoskeleton exo = random_device(random);
    JointArray wanted{};
    for (const ExoJoint& joint : exo.joints)
      wanted[static_cast<std::size_t>(joint.joint)] = random.between(-0.2, 0.2);
    const Rendered r = render(exo, wanted);
    const std::vector<double> best = best_by_brute_force(exo, wanted);
    ASSERT_EQ(best.size(), exo.motors.size());
    JointArray best_torque{};
    for (std::size_t m = 0; m < best.size(); ++m) {
      EXPECT_NEAR(r.force[m], best[m], 1e-4) << "motor " << m;
      EXPECT_GE(r.force[m], exo.motors[m].pull_only ? -exo.motors[m].bias : -exo.motors[m].force_limit);
      EXPECT_LE(r.force[m] + exo.motors[m].bias, exo.motors[m].force_limit * (1 + 1e-15));
      for (std::size_t j = 0; j < kJoints; ++j) best_torque[j] += exo.motors[m].arm[j] * best[m];
    }
    for (std::size_t j = 0; j < kJoints; ++j) {
      EXPECT_NEAR(r.torque[j], best_torque[j], 1e-8) << "joint " << j;
      EXPECT_EQ(r.unrendered[j], wanted[j] - r.torque[j]);
    }
    saturated += r.saturated ? 1 : 0;
    redundant += exo.motors.size() > exo.joints.size() ? 1 : 0;
  }
  EXPECT_GT(saturated, 50);  // or the cases would say nothing about bounds
  EXPECT_GT(redundant, 50);
}

TEST(Transmission, StaysFiniteAndBoundedWhateverArrives) {
  Exoskeleton exo = two_joint_device();
  exo.motors.push_back(motor_on("both", 4, 0.01));
  exo.motors[2].arm[6] = 0.02;
  const Transmission transmission(exo);
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double evil : {kNotANumber, kInfinite, -kInfinite, 1e308, -1e308, 1e-320}) {
    for (int joint = 0; joint < kJoints; ++joint) {
      Rendered r;
      JointArray wanted = torque_on(joint, evil);
      wanted[6] += 0.01;
      transmission.render(wanted, r);
      for (std::size_t m = 0; m < 3; ++m) EXPECT_LE(std::abs(r.force[m]), 10.0);
      for (std::size_t j = 0; j < kJoints; ++j)
        EXPECT_TRUE(std::isfinite(r.asked[j]) && std::isfinite(r.torque[j]) &&
                    std::isfinite(r.unrendered[j]));
    }
  }
  EXPECT_EQ(render(exo, torque_on(4, kNotANumber)).asked[4], 0.0);
}

TEST(Transmission, AllocatesNothingAndGivesTheSameBits) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Transmission transmission(random_device(random));
    JointArray wanted{};
    for (double& torque : wanted) torque = random.between(-0.3, 0.3);
    Rendered first, second;
    const std::size_t before = test::allocations_of_this_thread();
    transmission.render(wanted, first);
    EXPECT_EQ(test::allocations_of_this_thread(), before);
    transmission.render(wanted, second);
    EXPECT_EQ(std::memcmp(first.force.data(), second.force.data(), sizeof(first.force)), 0);
    EXPECT_EQ(std::memcmp(first.unrendered.data(), second.unrendered.data(), sizeof(first.unrendered)), 0);
  }
}

}  // namespace
}  // namespace phalanx
