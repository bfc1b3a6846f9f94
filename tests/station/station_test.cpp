// SPDX-License-Identifier: Apache-2.0
// The station with the simulated device in the same process. Its time is the number of steps, so that a busy
// machine changes nothing but how long these tests take.
#include "phalanx/station/station.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "phalanx/scene/build_model.h"
#include "phalanx/station/resolved_station.h"
#include "station/sensor_watch.h"
#include "station/small_station.h"
#include "station/watched_device.h"
#include "support/reading_helper.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

class StationTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { test::read_meshes_in_helper(); }

  /// Four times as fast as real time; overruns are judged only where a test asks for it.
  void start(const Overrides& overrides = {}, double slowdown = 0.25, int overruns = 1000000) {
    scene_ = load_scene(PHALANX_SOURCE_DIR "/scenes/grasp_teapot.toml", overrides);
    const ResolvedScene scene = resolve(scene_, {.device = true, .motion = true});
    StationModel made = make_station_model(scene, "");
    made.safety.overruns = overruns;
    model_ = made.model;
    clock_ = std::make_unique<Clock>(slowdown);
    device_ =
        std::make_unique<test::WatchedDevice>(make_simulated_device(simulated_settings(scene, *made.model)));
    device_->open();
    StationOptions options;
    options.ask_for_realtime = false;
    options.safety = made.safety;
    const Exoskeleton& exoskeleton = scene.exoskeleton.value();
    options.witnesses = motor_witnesses(exoskeleton, device_->info().channels, made.safety.joint_torque);
    ChannelMap map(device_->info().channels, followers_of(exoskeleton), made.model->hand.parameters());
    station_ =
        std::make_unique<Station>(made.model, made.parameters, *device_, std::move(map), options, *clock_);
    station_->start();
  }

  /// Waits, for minutes at most. @returns whether it came
  bool until(const std::function<bool(const StationView&)>& condition) {
    const Clock real;
    while (real.now() < 300.0) {
      if (condition(station_->view())) return true;
      clock_->sleep_until(clock_->now() + 0.01);
    }
    return false;
  }
  bool until_pressing(double newtons) {
    return until([&](const StationView& view) {
      return view.state == SafetyState::kRunning && index_force(view) > newtons;
    });
  }
  /// Asks for the exchange of the teapot for one of 125 mm.
  void exchange_teapot() {
    const SceneDescription other =
        load_scene(PHALANX_SOURCE_DIR "/scenes/grasp_teapot.toml", {{"objects.0.size_mm", "125"}});
    const StationModel made = make_station_model(other, "");
    station_->replace(made.model, made.parameters);
  }
  /// Waits for the end of a change that was asked for before. @returns whether it came
  bool until_changed() {
    const double asked = station_->view().time;
    const bool changed =
        until([&](const StationView& view) { return view.time > asked + 0.02 && !view.changing; });
    static_cast<void>(station_->view());  // frees what was exchanged
    return changed;
  }
  static double index_force(const StationView& view) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force += view.snapshot.segment[static_cast<std::size_t>(segment_index(1, k))].force;
    return force;
  }
  [[nodiscard]] double allowed_step() const {
    return scene_.parameters.limits.torque_rate / scene_.parameters.rate_hz + 1e-9;
  }

  SceneDescription scene_;
  std::shared_ptr<const HapticModel> model_;
  std::unique_ptr<Clock> clock_;
  std::unique_ptr<test::WatchedDevice> device_;
  std::unique_ptr<Station> station_;
};

TEST_F(StationTest, SqueezesTheTeapotFor30SecondsAt1KHzWithoutAFaultOrAnAllocationInTheLoop) {
  constexpr double kSeconds = test::kSlowBuild ? 8.0 : 30.0;
  start({{"rate_hz", "1000"}}, test::kSlowBuild ? 1.0 : 0.25);
  ASSERT_TRUE(until_pressing(1.0));
  ASSERT_TRUE(until([](const StationView& view) { return index_force(view) < 0.01; }));
  ASSERT_TRUE(until_pressing(1.0));
  ASSERT_TRUE(until([](const StationView& view) { return view.snapshot.time_s > kSeconds; }));
  EXPECT_GT(static_cast<double>(station_->deadlines().steps), 1000.0 * (kSeconds - 1.0));
  EXPECT_EQ(station_->view().state, SafetyState::kRunning);
  EXPECT_EQ(device_->allocations, 0U);
  EXPECT_LE(device_->largest_step, allowed_step());
  EXPECT_LE(device_->largest_torque, scene_.parameters.limits.joint_torque);
  station_->shut_down();
  EXPECT_TRUE(device_->at_zero);
  // The record of steps holds 8,192, and none has been fetched.
  const std::uint64_t steps = station_->deadlines().steps;
  EXPECT_EQ(station_->view().records_lost, steps > 8192 ? steps - 8192 : 0);
}

TEST_F(StationTest, StopGoesToZeroAndResumeComesBackOverTheRamp) {
  start();
  ASSERT_TRUE(until_pressing(0.5));
  station_->stop_torque();
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kStopped && view.at_rest; }));
  EXPECT_TRUE(device_->at_zero);
  station_->resume_torque();
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kRunning; }));
  EXPECT_LE(device_->largest_step, allowed_step());
}

TEST_F(StationTest, OfStopAndResumeTheLastWordCounts) {
  start();
  ASSERT_TRUE(until_pressing(0.5));
  station_->stop_torque();
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kStopped; }));
  station_->resume_torque();
  station_->stop_torque();
  const double asked = station_->view().time;
  ASSERT_TRUE(until([&](const StationView& view) { return view.time > asked + 1.0; }));
  EXPECT_EQ(station_->view().state, SafetyState::kStopped);
  station_->resume_torque();
  station_->shut_down();  // an end is the last word of all
  EXPECT_TRUE(device_->at_zero);
  EXPECT_TRUE(station_->view().at_rest);
}

TEST_F(StationTest, AnObjectIsSwappedInContactWithoutATorqueStepBeyondTheRateLimit) {
  start();
  ASSERT_TRUE(until_pressing(1.0));
  exchange_teapot();
  ASSERT_TRUE(
      until([](const StationView& view) { return !view.changing && view.state == SafetyState::kRunning; }));
  ASSERT_TRUE(until_pressing(0.5));
  EXPECT_TRUE(device_->ticks_increase);  // a device takes an old tick for an old command
  EXPECT_LE(device_->largest_step, allowed_step());
  std::printf("object swapped in contact: largest torque step %.4f of %.4f Nm allowed\n",
              device_->largest_step.load(), allowed_step());
}

// An exchange stops for 0.2 s and starts again. A stop that is asked for meanwhile outlasts it.
TEST_F(StationTest, AStopWhileAnObjectIsExchangedHoldsAfterTheExchange) {
  start();
  ASSERT_TRUE(until_pressing(1.0));
  exchange_teapot();
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kStopping; }));
  station_->stop_torque();
  ASSERT_TRUE(until([](const StationView& view) { return !view.changing; }));
  const double asked = station_->view().time;
  ASSERT_TRUE(until([&](const StationView& view) { return view.time > asked + 1.5; }));
  EXPECT_EQ(station_->view().state, SafetyState::kStopped);
  EXPECT_EQ(station_->view().factor, 0.0);
  EXPECT_TRUE(device_->at_zero);
}

TEST_F(StationTest, SmoothingOffAndAStifferWallInContactStayWithinTheRateLimit) {
  start();
  ASSERT_TRUE(until_pressing(1.0));
  HapticParameters parameters = scene_.parameters;
  parameters.force.stiffness = 900.0;
  parameters.stabiliser.method = Stabiliser::kNone;
  station_->change_to(parameters);
  ASSERT_TRUE(until(
      [](const StationView& view) { return !view.changing && std::abs(view.stiffness - 900.0) < 1e-9; }));
  ASSERT_TRUE(until_pressing(0.5));
  EXPECT_LE(device_->largest_step, allowed_step());
  EXPECT_NE(station_->view().state, SafetyState::kFault);
}

// The parameters of a change that an exchange overtakes never reach the other model, and those of a change
// after it do.
TEST_F(StationTest, AChangeGoesToTheModelThatItWasAskedFor) {
  start();
  ASSERT_TRUE(until_pressing(1.0));
  HapticParameters parameters = scene_.parameters;
  parameters.force.stiffness = 1000.0;
  station_->change_to(parameters);
  exchange_teapot();
  ASSERT_TRUE(until_changed());
  EXPECT_EQ(station_->view().stiffness, scene_.parameters.force.stiffness);
  exchange_teapot();
  parameters.force.stiffness = 800.0;
  station_->change_to(parameters);
  ASSERT_TRUE(until(
      [](const StationView& view) { return !view.changing && std::abs(view.stiffness - 800.0) < 1e-9; }));
}

TEST_F(StationTest, AChangeInContactIsRefusedOutsideTheRangesAndTheRate) {
  start();
  const auto refused = [&](const std::string& named, auto change) {
    HapticParameters parameters = scene_.parameters;
    change(parameters);
    EXPECT_THAT([&] { station_->change_to(parameters); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(named)));
  };
  refused("rate_hz", [](HapticParameters& p) { p.rate_hz *= 2.0; });
  refused("force.stiffness", [](HapticParameters& p) { p.force.stiffness = -1.0; });
  refused("force.damping",
          [](HapticParameters& p) { p.force.damping = std::numeric_limits<double>::quiet_NaN(); });
  refused("max_rate", [](HapticParameters& p) { p.stabiliser.max_rate = 0.0; });
}

// A change in contact and an exchange of parameters share the model; the exchange gives back what it
// replaced.
TEST_F(StationTest, OtherParametersCopyNoModel) {
  start();
  ASSERT_EQ(model_.use_count(), 2) << "the station's and this test's";
  HapticParameters parameters = scene_.parameters;
  parameters.force.stiffness = 700.0;
  station_->change_to(parameters);
  ASSERT_TRUE(until(
      [](const StationView& view) { return !view.changing && std::abs(view.stiffness - 700.0) < 1e-9; }));
  EXPECT_EQ(model_.use_count(), 2);
  parameters.force.law = ForceLaw::kDuffing;
  station_->replace(model_, parameters);
  ASSERT_TRUE(until_changed());
  EXPECT_EQ(station_->view().stiffness, 700.0);
  EXPECT_EQ(model_.use_count(), 2);
  parameters.force.stiffness = -1.0;
  EXPECT_THROW(station_->replace(model_, parameters), std::invalid_argument);
  EXPECT_EQ(model_.use_count(), 2) << "a refused exchange keeps nothing";
  exchange_teapot();
  ASSERT_TRUE(until_changed());
  EXPECT_EQ(model_.use_count(), 1) << "the station has another";
}

TEST_F(StationTest, ASilentDeviceIsAFaultWithTheLastTwoSecondsInItsReport) {
  start();
  ASSERT_TRUE(until([](const StationView& view) { return view.snapshot.time_s > 2.5; }));
  device_->silent = true;
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kFault && view.at_rest; }));
  std::optional<FaultReport> report;
  AngleOrigins shown{};
  ASSERT_TRUE(until([&](const StationView& view) {
    shown = view.snapshot.angle_origin;
    return (report = station_->take_fault_report()).has_value();
  }));
  EXPECT_EQ(report->angle_origin, shown);
  EXPECT_NE(report->angle_origin, AngleOrigins{}) << "the device copies digits that it does not have";
  EXPECT_EQ(report->event.fault, Fault::kNoSample);
  EXPECT_EQ(report->samples.size(), 2000U);
  EXPECT_EQ(report->steps.size(), 400U);
  EXPECT_EQ(report->steps.back().state, SafetyState::kFault);
  EXPECT_GT(report->link.received, 2000U);
  EXPECT_TRUE(device_->one_thread) << "a device's calls belong to the loop's thread (device.h)";
  EXPECT_TRUE(device_->at_zero);
  EXPECT_FALSE(station_->take_fault_report().has_value());
}

TEST_F(StationTest, AnEmergencyStopLatchesUntilItIsReleasedAndReset) {
  start();
  ASSERT_TRUE(until_pressing(0.5));
  device_->estop = true;
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kFault && view.at_rest; }));
  EXPECT_EQ(station_->view().fault.fault, Fault::kEmergencyStop);
  EXPECT_TRUE(station_->take_fault_report().has_value());
  station_->reset();
  const double asked = station_->view().time;
  ASSERT_TRUE(until([&](const StationView& view) { return view.time > asked + 0.5; }));
  EXPECT_EQ(station_->view().state, SafetyState::kFault);
  EXPECT_EQ(station_->view().resets_refused, 1U);
  device_->estop = false;
  ASSERT_TRUE(until([](const StationView& view) { return !view.estop; }));
  station_->reset();
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kRunning; }));
  EXPECT_EQ(station_->view().resets_refused, 1U);
  device_->estop = true;
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kFault && view.at_rest; }));
  EXPECT_TRUE(station_->take_fault_report().has_value()) << "the next fault has a report of its own";
}

TEST_F(StationTest, ARecordSaysWhatTheViewOfItsStepShows) {
  start();
  ASSERT_TRUE(until_pressing(1.0));
  const StationView shown = station_->view();
  StepRecord record;
  bool found = false;
  std::vector<DeviceSample> samples;
  while (!found && station_->next_record(record, samples)) found = record.input.time == shown.time;
  ASSERT_TRUE(found);
  for (int digit = 0; digit < kDigits; ++digit) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force += shown.snapshot.segment[static_cast<std::size_t>(segment_index(digit, k))].force;
    EXPECT_NEAR(record.force[static_cast<std::size_t>(digit)], force, 1e-12) << digit;
  }
  EXPECT_EQ(record.angle, shown.snapshot.hcp_angle);
  EXPECT_EQ(record.command.torque, shown.sent);
  EXPECT_EQ(record.state, shown.state);
  EXPECT_EQ(record.factor, shown.factor);
  EXPECT_EQ(record.stiffness, shown.stiffness);
  EXPECT_EQ(record.duration, shown.duration);
  EXPECT_GT(record.samples, 0U);
  EXPECT_EQ(shown.records_lost, 0U);
  // The longest of all steps. A step's duration ends after its command was sent, and is known once the next
  // step has begun.
  ASSERT_TRUE(until([&](const StationView& view) { return view.time > shown.time; }));
  EXPECT_GE(record.duration, -1e-12) << "of two readings of a clock that stands still, but for rounding";
  EXPECT_LE(record.duration, 1e-6 * station_->deadlines().step.max_us() + 1e-9);
}

// The same with torque: tests/faults/load_and_change_test.cpp.
TEST_F(StationTest, StepsThatAreTooLongAreCountedShownAndStoppedAfterTenInARow) {
  start({}, 2.0, 10);
  device_->delay = 2.0 * 0.0055;  // 5.5 ms of the station's clock; its period is 5 ms
  ASSERT_TRUE(until([](const StationView& view) { return view.degraded; }));
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kFault; }));
  EXPECT_EQ(station_->view().fault.fault, Fault::kOverload);
  EXPECT_GE(station_->deadlines().longest_run, 10U);
  EXPECT_GE(station_->deadlines().overruns, 10U);
}

TEST_F(StationTest, ARateOutsideItsRangeIsRefused) {
  EXPECT_THROW(start({{"rate_hz", "100"}}), std::invalid_argument);
  EXPECT_THROW(start({{"rate_hz", "2500"}}), std::invalid_argument);
  start({{"rate_hz", "2000"}});
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kRunning; }));
}

// The ramp's 40 steps of 5 ms take 40 or 45 ms each, 1.8 s at most: who shuts down waits for 2 s beyond 0.2
// s.
TEST(StationEnd, WaitsForARampWhoseStepsAreSlow) {
  const Clock clock;
  auto device = std::make_unique<test::WatchedDevice>(test::resting_device());
  test::WatchedDevice& watched = *device;
  const RunningStation running = test::small_station(std::move(device), clock);
  running.station->start();
  const auto state = [&] { return running.station->view().state; };
  for (int i = 0; i < 1000 && state() != SafetyState::kRunning; ++i) clock.sleep_until(clock.now() + 0.01);
  ASSERT_EQ(state(), SafetyState::kRunning);
  watched.delay = 0.04;
  running.station->shut_down();
  EXPECT_EQ(state(), SafetyState::kStopped);
  EXPECT_EQ(running.station->view().factor, 0.0);
}

}  // namespace
}  // namespace phalanx
