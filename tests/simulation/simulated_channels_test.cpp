// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/simulated_channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/squeezing_device.h"

namespace phalanx::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

SimulatedExoskeleton device_at(const SimulatedDeviceSettings& settings, double mcp, double pip) {
  JointArray start{};
  start[idx(kMcp)] = mcp;
  start[idx(kPip)] = pip;
  return {settings.exoskeleton, settings.patient, settings.hand.open_angle, start, 1};
}

TEST(SimulatedChannels, AreAnglesThenMotorsThenTorques) {
  SimulatedDeviceSettings settings = squeezing_settings();
  settings.exoskeleton.joints[1].torque_sensor = false;
  settings.exoskeleton.joints[0].sensor_lsb = 1e-3;
  const auto channels = simulated_channels(settings.exoskeleton, settings.hand);
  ASSERT_EQ(channels.size(), 5U);
  EXPECT_EQ(channels[0].kind, ChannelKind::kAngle);
  EXPECT_EQ(channels[0].index, kMcp);
  EXPECT_EQ(channels[0].gain, 1e-3) << "its sensor's least significant bit";
  EXPECT_EQ(channels[1].index, kPip);
  EXPECT_EQ(channels[1].gain, 10e-6);
  EXPECT_EQ(channels[2].kind, ChannelKind::kMotor);
  EXPECT_EQ(channels[2].index, 0);
  EXPECT_EQ(channels[3].index, 1);
  EXPECT_EQ(channels[4].kind, ChannelKind::kTorque);
  EXPECT_EQ(channels[4].index, kMcp);
}

// simple_hand's flexion goes from -0.5 to 2 rad.
TEST(SimulatedChannels, AnAnglesRangeIsItsJointsAndTwentyDegrees) {
  const SimulatedDeviceSettings settings = squeezing_settings();
  const auto channels = simulated_channels(settings.exoskeleton, settings.hand);
  EXPECT_EQ(channels[0].raw_min, std::lround((-0.5 - 20.0 * kDegree) / 10e-6));
  EXPECT_EQ(channels[0].raw_max, std::lround((2.0 + 20.0 * kDegree) / 10e-6));
}

// With 20 degrees beyond it the flexion goes from -0.849066 to 2.349066 rad. The tendons' arms are -12.5 and
// -10 mm: they wind from -29.3633 to 10.6133 mm and from -23.4907 to 8.4907 mm, and 5 mm more either way.
// Four times what 30 N do on these arms are 1.5 and 1.2 Nm.
TEST(SimulatedChannels, AMotorsAndATorquesRangeHaveTheirReserve) {
  const SimulatedDeviceSettings settings = squeezing_settings();
  const auto channels = simulated_channels(settings.exoskeleton, settings.hand);
  ASSERT_EQ(channels.size(), 6U);
  EXPECT_EQ(channels[2].raw_min, -34363);
  EXPECT_EQ(channels[2].raw_max, 15613);
  EXPECT_EQ(channels[3].raw_min, -28491);
  EXPECT_EQ(channels[3].raw_max, 13491);
  EXPECT_EQ(channels[4].raw_min, -15000);
  EXPECT_EQ(channels[4].raw_max, 15000);
  EXPECT_EQ(channels[5].raw_min, -12000);
  EXPECT_EQ(channels[5].raw_max, 12000);
}

TEST(SimulatedChannels, AnAngleComesBackWithinHalfACount) {
  const SimulatedDeviceSettings settings = squeezing_settings();
  const auto channels = simulated_channels(settings.exoskeleton, settings.hand);
  for (const double angle : {-0.4999, -1.23e-5, 0.0, 4.9e-6, 0.71828, 1.99999}) {
    SimulatedExoskeleton device = device_at(settings, angle, -angle / 4.0);
    device.measure_tick();
    std::array<std::int32_t, kMaxChannels> raw{};
    read_raw(device, channels, raw);
    EXPECT_NEAR(channels[0].gain * raw[0], angle, 0.5 * channels[0].gain * (1.0 + 1e-9));
    EXPECT_NEAR(channels[1].gain * raw[1], -angle / 4.0, 0.5 * channels[1].gain * (1.0 + 1e-9));
    for (std::size_t c = 0; c < channels.size(); ++c) {
      EXPECT_GE(raw[c], channels[c].raw_min) << c;
      EXPECT_LE(raw[c], channels[c].raw_max) << c;
    }
  }
}

// The tendons are without tension at the start: the motor has wound up arm times angle, -0.0125 0.8 m.
TEST(SimulatedChannels, AMotorReadsWhatItHasWoundUp) {
  const SimulatedDeviceSettings settings = squeezing_settings();
  const auto channels = simulated_channels(settings.exoskeleton, settings.hand);
  SimulatedExoskeleton device = device_at(settings, 0.8, 0.3);
  device.measure_tick();
  std::array<std::int32_t, kMaxChannels> raw{};
  read_raw(device, channels, raw);
  EXPECT_EQ(raw[kMotorChannel], -10000);
  EXPECT_EQ(raw[kMotorChannel + 1], -3000);
}

TEST(SimulatedChannels, CountsStayWithinThirtyTwoBits) {
  const SimulatedDeviceSettings settings = squeezing_settings();
  SimulatedExoskeleton device = device_at(settings, 1.0, -0.4);
  device.measure_tick();
  std::array<std::int32_t, kMaxChannels> raw{};
  read_raw(device,
           {{.kind = ChannelKind::kAngle, .index = kMcp, .gain = 1e-12},
            {.kind = ChannelKind::kAngle, .index = kPip, .gain = 1e-12}},
           raw);
  EXPECT_EQ(raw[0], std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(raw[1], std::numeric_limits<std::int32_t>::min());
}

TEST(SimulatedChannels, MoreThanTheLinkCarriesIsRefused) {
  SimulatedDeviceSettings settings = squeezing_settings();
  settings.exoskeleton.joints.clear();
  settings.exoskeleton.motors.clear();
  for (int j = 0; j < kJoints; ++j) {
    settings.exoskeleton.joints.push_back(joint_of(j));
    if (j < 12) settings.exoskeleton.motors.push_back(motor_on("m", j, 0.01));
  }
  EXPECT_EQ(simulated_channels(settings.exoskeleton, settings.hand).size(), kMaxChannels);
  settings.exoskeleton.joints[3].torque_sensor = true;
  EXPECT_THROW(static_cast<void>(simulated_channels(settings.exoskeleton, settings.hand)),
               std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::test
