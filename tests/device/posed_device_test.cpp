// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/posed_device.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <stdexcept>
#include <thread>

#include "phalanx/core/random.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/station/resolved_station.h"
#include "phalanx/station/station.h"
#include "station/safety.h"
#include "station/watched_device.h"
#include "support/count_allocations.h"
#include "support/sanitized.h"
#include "support/simple_hand.h"

namespace phalanx::test {
namespace {

constexpr std::uint64_t kSeed = 20260;
constexpr std::size_t kPosedJoint = 6;                        ///< index_pip_flexion, -0.5 .. 2 rad
constexpr double kCount = 10e-6;                              ///< [rad]
constexpr double kEnds = std::numeric_limits<double>::max();  ///< beyond every range

PosedDeviceSettings settings_at(double rate_hz = 200.0) {
  PosedDeviceSettings settings;
  settings.hand = simple_parameters();
  settings.host_rate_hz = rate_hz;
  return settings;
}

JointArray all_at(double angle) {
  JointArray out;
  out.fill(angle);
  return out;
}

/// A host that reads a sample and sends a command a step.
class PosedLoop {
 public:
  explicit PosedLoop(const PosedDeviceSettings& settings = settings_at())
      : device(settings), period(1.0 / settings.host_rate_hz) {
    device.open();
  }

  void step(bool enable = true) {
    now += period;
    ASSERT_EQ(device.receive(now, std::span(&newest, 1)), 1U);
    ++command.tick;
    command.enable = enable;
    device.send(command);
  }
  void run(double seconds, bool enable = true) {
    for (long i = std::lround(seconds / period); i > 0; --i) step(enable);
  }
  [[nodiscard]] double angle(std::size_t joint) const { return kCount * newest.raw[joint]; }

  PosedDevice device;
  double period;
  double now = 0.0;
  DeviceSample newest{};
  DeviceCommand command{};
};

TEST(PosedDevice, HasAnAngleChannelForEveryJointAndNoMotor) {
  const PosedDevice device(settings_at(500.0));
  const DeviceInfo& info = device.info();
  EXPECT_EQ(info.serial, "sliders");
  EXPECT_EQ(info.rate_hz, 500.0);
  EXPECT_TRUE(info.simulated);
  EXPECT_TRUE(info.renders_torque);
  ASSERT_EQ(info.channels.size(), static_cast<std::size_t>(kJoints));
  for (std::size_t c = 0; c < info.channels.size(); ++c) {
    EXPECT_EQ(info.channels[c].kind, ChannelKind::kAngle);
    EXPECT_EQ(info.channels[c].index, static_cast<int>(c));
  }
}

TEST(PosedDevice, EachCallGivesOneSampleOnePeriodLater) {
  PosedLoop loop(settings_at(300.0));
  for (int i = 1; i <= 9; ++i) {
    loop.step();
    EXPECT_EQ(loop.newest.sequence, static_cast<std::uint32_t>(i));
    EXPECT_EQ(loop.newest.time_us, static_cast<std::uint64_t>(std::llround(1e6 * i / 300.0)));
    EXPECT_EQ(loop.newest.received, loop.now);
  }
  EXPECT_EQ(loop.device.statistics().received, 9U);
  EXPECT_EQ(loop.device.statistics().sent, 9U);
  EXPECT_EQ(loop.device.receive(1.0, {}), 0U);
  EXPECT_EQ(loop.device.statistics().overflowed, 1U);
  loop.run(10.0);  // 3010 periods of 1/300 s since the beginning
  EXPECT_EQ(loop.newest.time_us, 10'033'333U);
}

TEST(PosedDevice, StartsAtItsStartWithinTheRange) {
  PosedDeviceSettings settings = settings_at();
  settings.start = all_at(0.25);
  settings.start[kPosedJoint] = 5.0;
  PosedLoop loop(settings);
  loop.run(0.1);
  EXPECT_NEAR(loop.angle(0), 0.25, kCount);
  EXPECT_NEAR(loop.angle(kPosedJoint), 2.0, kCount);
}

// x(t) = d (1 - (1 + t/T) exp(-t/T)): after one time constant of 50 ms, 10 steps, 0.26424 d.
TEST(PosedDevice, ASmallMoveIsCriticallyDamped) {
  PosedLoop loop;
  loop.step();
  loop.device.pose(all_at(0.1));
  loop.run(0.05);
  EXPECT_NEAR(loop.angle(kPosedJoint), 0.026424, kCount);
  double before = loop.angle(kPosedJoint);
  for (int i = 0; i < 200; ++i) {
    loop.step();
    EXPECT_GE(loop.angle(kPosedJoint), before);
    EXPECT_LE(loop.angle(kPosedJoint), 0.1 + kCount) << "no overshoot";
    before = loop.angle(kPosedJoint);
  }
  EXPECT_NEAR(before, 0.1, kCount);
}

// 2.5 rad at 6 rad/s at most, and there within a second.
TEST(PosedDevice, FromEndToEndItKeepsItsSpeedAndArrives) {
  PosedLoop loop;
  loop.device.pose(all_at(-kEnds));
  loop.run(2.0);
  EXPECT_NEAR(loop.angle(kPosedJoint), -0.5, kCount);
  loop.device.pose(all_at(kEnds));
  double fastest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double before = loop.angle(kPosedJoint);
    loop.step();
    fastest = std::max(fastest, (loop.angle(kPosedJoint) - before) / loop.period);
  }
  EXPECT_NEAR(loop.angle(kPosedJoint), 2.0, kCount);
  EXPECT_LE(fastest, 6.0 + kCount / loop.period);
  EXPECT_GE(fastest, 5.5) << "the speed is made use of";
}

TEST(PosedDevice, NoPlayOfTheSlidersExceedsSpeedOrRange) {
  for (const double rate : {10.0, 200.0, 700.0, 2000.0}) {
    SCOPED_TRACE(testing::Message() << rate << " Hz, seed " << kSeed);
    Random random(kSeed);
    PosedLoop loop(settings_at(rate));
    loop.step();
    const double most = 6.0 * loop.period + 2.0 * kCount;
    for (int i = 0; i < 20000; ++i) {
      if (random.uniform() < 0.05) {
        JointArray target;
        for (double& angle : target) angle = random.between(-1.0, 2.5);
        loop.device.pose(target);
      }
      const std::array<std::int32_t, kMaxChannels> before = loop.newest.raw;
      loop.step();
      for (std::size_t j = 0; j < kJoints; ++j) {
        ASSERT_LE(std::abs(kCount * (loop.newest.raw[j] - before[j])), most);
        ASSERT_GE(loop.angle(j), loop.device.info().channels[j].raw_min * kCount + 0.3);
        ASSERT_LE(loop.angle(j), loop.device.info().channels[j].raw_max * kCount - 0.3);
      }
    }
  }
}

TEST(PosedDevice, WhatIsNotFiniteStaysWhereItWas) {
  PosedLoop loop;
  loop.device.pose(all_at(0.3));
  JointArray target = all_at(0.4);
  target[0] = std::nan("");
  target[kPosedJoint] = std::numeric_limits<double>::infinity();
  loop.device.pose(target);
  loop.run(2.0);
  EXPECT_NEAR(loop.angle(0), 0.3, kCount);
  EXPECT_NEAR(loop.angle(kPosedJoint), 0.3, kCount);
  EXPECT_NEAR(loop.angle(kPosedJoint + 1), 0.4, kCount);
}

TEST(PosedDevice, ItsStateFollowsTheCommands) {
  PosedLoop loop;
  loop.step(false);
  EXPECT_EQ(loop.newest.state, DeviceState::kReady);
  EXPECT_EQ(loop.newest.factor, 0.0);
  loop.run(0.5);
  EXPECT_EQ(loop.newest.state, DeviceState::kStarting);
  EXPECT_NEAR(loop.newest.factor, 0.5, 0.01);
  EXPECT_EQ(loop.newest.acted_tick, 100U) << "what was sent after the sample before";
  loop.run(0.6);
  EXPECT_EQ(loop.newest.state, DeviceState::kActive);
  EXPECT_EQ(loop.newest.factor, 1.0);
  loop.step(false);
  loop.step(true);
  EXPECT_EQ(loop.newest.state, DeviceState::kReady);
  loop.run(0.1);
  EXPECT_LT(loop.newest.factor, 0.2) << "a fresh ramp";
  loop.command.fault = true;
  loop.run(0.02);
  EXPECT_EQ(loop.newest.state, DeviceState::kReady) << "a host in fault";
  EXPECT_EQ(loop.newest.factor, 0.0);
  loop.command.fault = false;
  loop.run(0.02);
  loop.device.reset();
  loop.step();
  EXPECT_EQ(loop.newest.state, DeviceState::kReady);
  loop.step();
  EXPECT_EQ(loop.newest.state, DeviceState::kStarting);
}

TEST(PosedDevice, ClosedItGivesNothingAndOpensAgainWithItsClock) {
  PosedLoop loop;
  loop.run(0.1);
  loop.device.close();
  loop.device.close();
  loop.device.send(loop.command);
  EXPECT_EQ(loop.device.receive(1.0, std::span(&loop.newest, 1)), 0U);
  EXPECT_EQ(loop.device.statistics().sent, 20U);
  loop.device.open();
  loop.step();
  EXPECT_EQ(loop.newest.state, DeviceState::kReady);
  EXPECT_EQ(loop.newest.time_us, 21U * 5000U);
}

TEST(PosedDevice, SettingsThatMakeNoSenseAreRefused) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    PosedDeviceSettings rate = settings_at(bad);
    EXPECT_THROW(PosedDevice{rate}, std::invalid_argument);
    PosedDeviceSettings speed = settings_at();
    speed.speed = bad;
    EXPECT_THROW(PosedDevice{speed}, std::invalid_argument);
    PosedDeviceSettings slow = settings_at();
    slow.time_constant = bad;
    EXPECT_THROW(PosedDevice{slow}, std::invalid_argument);
  }
  PosedDeviceSettings start = settings_at();
  start.start[kPosedJoint] = std::nan("");
  EXPECT_THROW(PosedDevice{start}, std::invalid_argument);
}

TEST(PosedDevice, TheLoopsCallsAllocateNothing) {
  PosedLoop loop;
  loop.step();
  const std::size_t before = allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) {
    loop.device.pose(all_at(0.01 * i));
    loop.run(0.05);
    loop.device.reset();
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

// For ThreadSanitizer, and whole poses: all joints are told the same, so all read the same.
TEST(PosedDevice, OneThreadPosesWhileAnotherLoops) {
  PosedLoop loop;
  loop.step();
  std::atomic<bool> done{false};
  std::thread sliders([&] {
    Random random(kSeed);
    while (!done) loop.device.pose(all_at(random.between(-0.5, 0.6)));
  });
  for (int i = 0; i < 20000; ++i) {
    loop.step();
    for (std::size_t j = 1; j < kJoints; ++j) EXPECT_EQ(loop.newest.raw[j], loop.newest.raw[0]) << "torn";
  }
  done = true;
  sliders.join();
}

/// Safety with the device alone; torque 0.3 Nm on every joint, whatever the pose.
class Watch {
 public:
  explicit Watch(double rate_hz)
      : loop_(settings_at(rate_hz)),
        map_(loop_.device.info().channels, {}, simple_parameters()),
        safety_({}, map_, loop_.device.info(), simple_parameters(), {}, loop_.period) {
    snapshot_.torque.fill(0.3);
  }

  void step() {
    loop_.now += loop_.period;
    ASSERT_EQ(loop_.device.receive(loop_.now, std::span(&loop_.newest, 1)), 1U);
    map_.convert(loop_.newest, sample_);
    snapshot_.hcp_angle = sample_.angle;
    safety_.observe(std::span(&loop_.newest, 1), loop_.device.connection_fault(), false, loop_.now);
    safety_.command(snapshot_, loop_.newest, loop_.now, loop_.command);
    loop_.device.send(loop_.command);
  }
  [[nodiscard]] PosedDevice& device() { return loop_.device; }
  [[nodiscard]] Safety& safety() { return safety_; }

 private:
  PosedLoop loop_;
  ChannelMap map_;
  Safety safety_;
  Sample sample_;
  Snapshot snapshot_;
};

TEST(PosedDevice, HoursOfPlayWithStopsAndResumesAreNoFault) {
  const std::array<std::pair<double, double>, 3> kRateAndHours = {
      {{200.0, 3.0}, {1000.0, 0.5}, {2000.0, 0.25}}};
  for (const auto& [rate, hours] : kRateAndHours) {
    SCOPED_TRACE(testing::Message() << rate << " Hz, seed " << kSeed);
    Random random(kSeed);
    Watch watch(rate);
    bool ran = false;
    const auto steps = static_cast<long>(rate * hours * (test::kSlowBuild ? 360.0 : 3600.0));
    for (long i = 0; i < steps; ++i) {
      const double dice = random.uniform() * rate;  // below 1: once a second
      if (dice < 4.0) {
        JointArray target;
        for (double& angle : target) angle = random.uniform() < 0.5 ? -kEnds : kEnds;
        watch.device().pose(target);
      }
      if (dice > rate - 0.1) watch.safety().stop();
      if (dice < 0.3) watch.safety().start();
      watch.step();
      ran = ran || watch.safety().state() == SafetyState::kRunning;
      ASSERT_NE(watch.safety().state(), SafetyState::kFault)
          << fault_meaning(watch.safety().fault().fault) << " after " << static_cast<double>(i) / rate
          << " s";
    }
    EXPECT_TRUE(ran);
  }
}

// ---- in a station ----

class PosedInStation : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = load_scene(PHALANX_SOURCE_DIR "/scenes/grasp_teapot.toml", {});
    const ResolvedScene scene = resolve(scene_, {.device = true, .motion = true});
    motion_ = scene.motion.value();
    const StationModel made = make_station_model(scene, "");
    auto posed = std::make_unique<PosedDevice>(PosedDeviceSettings{
        .hand = made.model->hand.parameters(), .start = open(), .host_rate_hz = scene_.parameters.rate_hz});
    posed_ = posed.get();
    watched_ = std::make_unique<WatchedDevice>(std::move(posed));
    watched_->open();
    StationOptions options;
    options.ask_for_realtime = false;
    options.safety = made.safety;
    const Exoskeleton& exoskeleton = scene.exoskeleton.value();
    options.witnesses = motor_witnesses(exoskeleton, watched_->info().channels, made.safety.joint_torque);
    ChannelMap map(watched_->info().channels, followers_of(exoskeleton), made.model->hand.parameters());
    station_ =
        std::make_unique<Station>(made.model, made.parameters, *watched_, std::move(map), options, clock_);
    station_->start();
  }

  [[nodiscard]] JointArray open() const { return motion_.at(0.0); }
  [[nodiscard]] JointArray closed() const {
    return motion_.at(scene_.motion.script.start_s + scene_.motion.script.close_s);
  }
  /// Waits, for ten seconds of the held clock at most. @returns whether it came
  bool until(const std::function<bool(const StationView&)>& condition) {
    for (int i = 0; i < 1000; ++i) {
      if (condition(station_->view())) return true;
      clock_.sleep_until(clock_.now() + 0.01);
    }
    return false;
  }
  static double force(const StationView& view) {
    double sum = 0.0;
    for (const SegmentSnapshot& segment : view.snapshot.segment) sum += segment.force;
    return sum;
  }
  bool until_grasped() {
    return until([](const StationView& view) {
      return view.state == SafetyState::kRunning && force(view) > 1.0 && !view.at_rest;
    });
  }

  SceneDescription scene_;
  Motion motion_;
  Clock clock_;
  PosedDevice* posed_ = nullptr;
  std::unique_ptr<WatchedDevice> watched_;
  std::unique_ptr<Station> station_;
};

TEST_F(PosedInStation, GraspsTheTeapotStopsAndResumesWithoutAFault) {
  for (int i = 0; i < 5; ++i) {
    posed_->pose(closed());
    ASSERT_TRUE(until_grasped());
    posed_->pose(open());
    ASSERT_TRUE(until([](const StationView& view) { return force(view) == 0.0; }));
  }
  posed_->pose(closed());
  ASSERT_TRUE(until_grasped());
  station_->stop_torque();
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kStopped && view.at_rest; }));
  EXPECT_TRUE(watched_->at_zero);
  ASSERT_TRUE(until([](const StationView& view) { return view.device == DeviceState::kReady; }));
  station_->resume_torque();
  ASSERT_TRUE(until_grasped());
  EXPECT_EQ(watched_->allocations, 0U);
  station_->shut_down();
  EXPECT_TRUE(watched_->at_zero);
}

TEST_F(PosedInStation, ComesBackAfterAFaultAndItsReset) {
  posed_->pose(closed());
  ASSERT_TRUE(until_grasped());
  watched_->estop = true;
  ASSERT_TRUE(
      until([](const StationView& view) { return view.state == SafetyState::kFault && view.at_rest; }));
  EXPECT_TRUE(watched_->at_zero);
  watched_->estop = false;
  ASSERT_TRUE(until([](const StationView& view) { return !view.estop; }));
  posed_->pose(open());
  station_->reset();
  ASSERT_TRUE(until([](const StationView& view) { return view.state == SafetyState::kRunning; }));
  posed_->pose(closed());
  ASSERT_TRUE(until_grasped());
  EXPECT_EQ(station_->view().device, DeviceState::kActive);
}

}  // namespace
}  // namespace phalanx::test
