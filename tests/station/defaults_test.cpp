// SPDX-License-Identifier: Apache-2.0
// Default values of the station.
#include <gtest/gtest.h>

#include <numbers>

#include "phalanx/device/device.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/safety.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/station/sensor_watch.h"
#include "support/zero_bytes.h"

namespace phalanx {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(StationDefaults, LimitsAreOn) {
  const SafetySettings settings;
  EXPECT_EQ(settings.fingertip_force, 5.0);
  EXPECT_EQ(settings.joint_torque, 0.5);
  EXPECT_EQ(settings.torque_rate, 10.0);
  EXPECT_DOUBLE_EQ(settings.range_taper, 3.0 * kDegree);
  EXPECT_EQ(settings.start_ramp, 1.0);
  EXPECT_EQ(settings.stop_ramp, 0.2);
  EXPECT_EQ(settings.fault_ramp, 0.005);
}

TEST(StationDefaults, WhenSamplesAreBelieved) {
  const SafetySettings settings;
  EXPECT_EQ(settings.sample_timeout, 0.010);
  EXPECT_EQ(settings.bad_samples, 3);
  EXPECT_EQ(settings.joint_speed, 40.0);
  EXPECT_DOUBLE_EQ(settings.jump_allowance, 2.0 * kDegree);
  EXPECT_DOUBLE_EQ(settings.range_margin, 20.0 * kDegree);
  EXPECT_EQ(settings.stuck_after, 0.5);
  EXPECT_EQ(settings.stuck_counts, 10.0);
  EXPECT_EQ(settings.torque_error, 0.15);
  EXPECT_EQ(settings.torque_error_part, 0.5);
  EXPECT_EQ(settings.torque_error_time, 0.2);
  EXPECT_EQ(settings.force_error, 2.0);
  EXPECT_EQ(settings.overruns, 10);
}

TEST(StationDefaults, NoFaultAndNoChannel) {
  const FaultEvent event;
  EXPECT_EQ(event.fault, Fault::kNone);
  EXPECT_EQ(event.channel, -1);
  EXPECT_EQ(event.time, 0.0);
  EXPECT_EQ(event.tick, 0U);
  EXPECT_FALSE(event.from_device);
  const SensorFinding finding;
  EXPECT_EQ(finding.fault, Fault::kNone);
  EXPECT_EQ(finding.channel, -1);
  const MotorWitness witness;
  EXPECT_EQ(witness.channel, -1);
  EXPECT_EQ(witness.slack, 0.0);
}

TEST(StationDefaults, ACommandThatNobodyFillsMovesNothing) {
  EXPECT_TRUE(test::begins_as_zero<DeviceCommand>());
}

TEST(StationDefaults, RealTimeIsAskedFor) {
  const RealtimeRequest request;
  EXPECT_EQ(request.priority, 80);
  EXPECT_EQ(request.cpu, -1);
  EXPECT_TRUE(request.lock_memory);
}

}  // namespace
}  // namespace phalanx
