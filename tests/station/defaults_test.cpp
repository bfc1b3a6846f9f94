// SPDX-License-Identifier: Apache-2.0
// Default values of the station.
#include <gtest/gtest.h>

#include <numbers>

#include "phalanx/device/device.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/station/session.h"
#include "station/pacer.h"
#include "station/safety.h"
#include "station/sensor_watch.h"
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
  EXPECT_EQ(settings.rate_window, 0.5);
  EXPECT_EQ(settings.rate_factor, 2.0);
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

TEST(StationDefaults, RealTimeIsAskedForAndNotGranted) {
  const RealtimeRequest request;
  EXPECT_EQ(request.priority, 80);
  EXPECT_EQ(request.cpu, -1);
  EXPECT_TRUE(request.lock_memory);
  EXPECT_TRUE(StationOptions{}.ask_for_realtime);
  EXPECT_TRUE(SessionSettings{}.ask_for_realtime);
  const RealtimeGrant grant;
  EXPECT_EQ(grant.scheduler, "SCHED_OTHER");
  EXPECT_FALSE(grant.fifo);
  EXPECT_FALSE(grant.memory_locked);
  EXPECT_EQ(grant.cpu, -1);
}

TEST(StationDefaults, NothingHasHappenedBeforeTheFirstStep) {
  EXPECT_TRUE(test::begins_as_zero<StepRecord>());
  EXPECT_TRUE(test::begins_as_zero<Wake>());
  const StationView view{};
  EXPECT_EQ(view.time, 0.0);
  EXPECT_EQ(view.stiffness, 0.0);
  EXPECT_EQ(view.duration, 0.0);
  EXPECT_EQ(view.sent, JointArray{});
  EXPECT_EQ(view.state, SafetyState::kWaiting);
  EXPECT_EQ(view.factor, 0.0);
  EXPECT_TRUE(view.at_rest);
  EXPECT_FALSE(view.degraded);
  EXPECT_FALSE(view.ending);
  EXPECT_FALSE(view.changing);
  EXPECT_FALSE(view.estop);
  EXPECT_EQ(view.device, DeviceState::kConnecting);
  EXPECT_EQ(view.resets_refused, 0U);
  EXPECT_EQ(view.records_lost, 0U);
  const DeadlineStatistics deadlines{};
  EXPECT_EQ(deadlines.period, 1e-3);
  EXPECT_EQ(deadlines.steps + deadlines.overruns + deadlines.overruns_in_row, 0U);
  EXPECT_EQ(deadlines.longest_run + deadlines.skipped + deadlines.step.count(), 0U);
  EXPECT_EQ(deadlines.last_overrun, 0.0);
}

TEST(StationDefaults, ASessionThatIsToldNothingRunsTheFirstSceneWithoutADevice) {
  const SessionSettings settings;
  EXPECT_EQ(settings.scene, "first_touch");
  EXPECT_EQ(settings.device, "simulated");
  const SessionInfo info{};
  EXPECT_EQ(info.revision, 0U);
  EXPECT_EQ(info.source, HandSource::kPatient);
  EXPECT_EQ(info.fingertip_force, 0.0);
  EXPECT_FALSE(info.running);
  const SessionGeometry geometry{};
  EXPECT_EQ(geometry.revision, 0U);
  EXPECT_EQ(geometry.handedness, Handedness::kRight);
  EXPECT_EQ(geometry.rate_hz, 0.0);
  EXPECT_FALSE(ChangeOutcome{}.overtaken);
}

}  // namespace
}  // namespace phalanx
