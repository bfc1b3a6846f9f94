// SPDX-License-Identifier: Apache-2.0
// The simulated controller's local walls, and what it does with whatever the host sends.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulated_cases.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

using test::at;
using test::held_device;
using test::kMcp;
using test::no_patient;
using test::posture;
using test::rendered_at_next;
using test::two_joint_device;

/// A wall of 400 N/m that holds 1 N in the host's command, 2.5 mm deep at the MCP angle 0.3 rad.
Snapshot wall_command(double time_s, double valid_for) {
  Snapshot snapshot;
  snapshot.time_s = time_s;
  snapshot.wall_valid_for = valid_for;
  snapshot.hcp_angle[at(kMcp)] = 0.3;
  LocalWall& wall = snapshot.wall[at(segment_index(1, 2))];
  wall = {.active = true, .d_ref = 2.5e-3, .stiffness = 400.0, .force_max = 4.0, .host_force = 1.0};
  wall.g[0] = -0.05;
  snapshot.torque[at(kMcp)] = -0.05;
  return snapshot;
}

double torque_with_wall_at(double mcp, const Snapshot& command) {
  SimulatedExoskeleton device(held_device(), no_patient(), {}, posture(mcp, 0.0), 1);
  device.send(command, 0.0);
  return rendered_at_next(device);
}

// n'J is -0.05 m: 0.02 rad further in is 1 mm, 0.4 N, 0.02 Nm.
TEST(SimulatedExoskeleton, EvaluatesALocalWallAtItsOwnAngles) {
  EXPECT_EQ(torque_with_wall_at(0.3, wall_command(0.0, 0.02)), -0.05);
  EXPECT_NEAR(torque_with_wall_at(0.32, wall_command(0.0, 0.02)), -0.07, 1e-12);
  EXPECT_NEAR(torque_with_wall_at(0.28, wall_command(0.0, 0.02)), -0.03, 1e-12);
  EXPECT_NEAR(torque_with_wall_at(0.2, wall_command(0.0, 0.02)), 0.0, 1e-12);     // out of it
  EXPECT_NEAR(torque_with_wall_at(0.4, wall_command(0.0, 0.02)), -0.125, 1e-12);  // 3 N, the motor's 10 N
  EXPECT_EQ(torque_with_wall_at(0.32, wall_command(0.0, 0.0)), -0.05);            // there are none
}

TEST(SimulatedExoskeleton, GoesBackToTheHostsTorqueWhenTheWallsAreOld) {
  SimulatedExoskeleton device(held_device(), no_patient(), {}, posture(0.32, 0.0), 1);
  device.send(wall_command(0.0, 5e-3), 0.0);
  for (int tick = 0; tick < 10; ++tick)
    EXPECT_NEAR(rendered_at_next(device), tick <= 5 ? -0.07 : -0.05, 1e-12) << tick;
}

TEST(SimulatedExoskeleton, TicksWithoutAllocation) {
  Exoskeleton exo = two_joint_device();
  exo.joints[0].sensor_noise = 1e-4;
  exo.controller.return_delay = 3e-3;
  SimulatedExoskeleton device(exo, no_patient(), {}, posture(0.32, 0.0), 1);
  const Snapshot command = wall_command(0.0, 0.02);
  const std::size_t before = test::allocations_of_this_thread();
  for (int tick = 0; tick < 100; ++tick) {
    device.begin_tick();
    device.send(command, device.time_s());
    device.end_tick({});
  }
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

TEST(SimulatedExoskeleton, StaysFiniteWithWhateverTheHostSends) {
  SimulatedExoskeleton device(two_joint_device(), no_patient(), {}, posture(0.32, 0.0), 1);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Snapshot command = wall_command(device.time_s(), 0.02);
    command.torque.fill(bad);
    command.wall[at(segment_index(1, 2))].d_ref = bad;
    device.send(command, device.time_s());
    IntendedMove move;
    move.to.fill(bad);
    for (int i = 0; i < 5; ++i) {
      device.begin_tick();
      for (const double q : device.sample().angle) EXPECT_TRUE(std::isfinite(q)) << bad;
      device.end_tick(move);
    }
  }
}

}  // namespace
}  // namespace phalanx
